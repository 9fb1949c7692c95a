#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The atlas in numbers, as it stands in docs/stability.md: how many points each method holds on each map, where a baseline
holds and ours does not, and where ours is worse than no limiter. Markdown."""

import argparse
import json
import math
from pathlib import Path

import maps
import outcome


MOST_LISTED = 12  # points of a map


def is_ours(method):
    return method["name"].startswith("apsl")


def named(label, value):
    """mass ratio 100 000; time step 1/60 s; speed 3 m/s."""
    if isinstance(value, str):
        return f"{label} {value}"
    name, _, unit = label.removesuffix(")").partition(" (")
    number = f"1/{round(1.0 / value)}" if name == "time step" else (
        f"{value:,.0f}".replace(",", " ") if value >= 1000 else f"{value:g}")
    return f"{name} {number}" + (f" {unit}" if unit else "")


def points_of(document):
    """(name of the point, row, column)."""
    if "cases" in document:
        return [(name, row, 0) for row, name in enumerate(document["cases"])]
    x, y = document["x"], document["y"]
    return [(f"{named(y['label'], b)}, {named(x['label'], a)}", row, column)
            for row, b in enumerate(y["values"]) for column, a in enumerate(x["values"])]


def count(method, letter):
    return "".join(method["outcome"]).count(letter)


def percent(change):
    if change is None:
        return "not finite"
    return f"{float(f'{100.0 * change:.2g}'):g} %" if change < 10.0 else "> 1000 %"


def judged(document):
    """The method that stands for ours: the defaults, on the map of α the paper's, on those of ceilings the ceiling."""
    methods = {method["name"]: method for method in document["methods"]}
    return methods.get("apsl_defaults") or methods.get("apsl") or methods["apsl_ceiling"]


def unlimited(document):
    return next(method for method in document["methods"] if method["name"] == "none")


def stretches(document):
    """Of the points that ours holds, the greatest length of an edge over its rest length, there and without a limiter."""
    ours = judged(document)
    held = [(row, column) for _, row, column in points_of(document) if ours["outcome"][row][column] == outcome.HELD]
    if not held or "edges" not in ours:
        return "–"
    longest = [max(method["edges"][row][column] or math.inf for row, column in held)
               for method in (ours, unlimited(document))]
    return "{:.3g} ({:.3g})".format(*longest)


def held_by_baselines_alone(document):
    ours = judged(document)
    for name, row, column in points_of(document):
        if ours["outcome"][row][column] == outcome.HELD:
            continue
        holding = [method for method in document["methods"]
                   if not is_ours(method) and method["outcome"][row][column] == outcome.HELD]
        if holding:
            best = min(holding, key=lambda method: method["greatest"][row][column])
            title = "no limiter" if best["name"] == "none" else best["title"]
            yield (f"{name}: ours {percent(ours['greatest'][row][column])}, "
                   f"{title} {percent(best['greatest'][row][column])}"
                   + (f", held by {len(holding)}" if len(holding) > 1 else ""))


def worse_than_none(document):
    ours = judged(document)
    without = unlimited(document)
    for name, row, column in points_of(document):
        letter = ours["outcome"][row][column]
        if letter == outcome.WORSE or (letter == outcome.DIVERGED_RUN
                                       and without["outcome"][row][column] != outcome.DIVERGED_RUN):
            yield (f"{name}: ours {percent(ours['greatest'][row][column])}, "
                   f"no limiter {percent(without['greatest'][row][column])}")


def gaining_energy(document):
    ours = judged(document)
    for name, row, column in points_of(document):
        if ours["outcome"][row][column] == outcome.GAINED_ENERGY:
            yield f"{name}: areas {percent(ours['greatest'][row][column])}"


def table(documents):
    lines = ["| map | points | no limiter holds | ours, the defaults | ours, the paper's | ours, printed "
             "| ours, the ceiling | best baseline "
             "| a baseline holds, ours does not | ours worse than no limiter | ours gains energy "
             "| longest edge where ours holds (without a limiter) |", "|---|---|---|---|---|---|---|---|---|---|---|---|"]
    for document in documents:
        methods = {method["name"]: method for method in document["methods"]}
        held = {name: str(count(method, outcome.HELD)) for name, method in methods.items()}
        baselines = [method for method in document["methods"] if not is_ours(method) and method["name"] != "none"]
        best = max(baselines, key=lambda method: count(method, outcome.HELD), default=None)
        lines.append("| " + " | ".join([
            f"[{document.get('title', 'Single cases')}](stability/{document['map']}.png)",
            str(len(points_of(document))),
            held["none"], *(held.get(name, "–") for name in ("apsl_defaults", "apsl", "apsl_printed", "apsl_ceiling")),
            "–" if best is None else f"{held[best['name']]} ({best['title']})",
            str(len(list(held_by_baselines_alone(document)))), str(len(list(worse_than_none(document)))),
            str(count(judged(document), outcome.GAINED_ENERGY)), stretches(document)]) + " |")
    return lines


def listed(documents, find):
    lines = []
    for document in documents:
        found = list(find(document))
        if len(found) > MOST_LISTED:
            found[MOST_LISTED - 1:] = [f"and {len(found) - MOST_LISTED + 1} more"]
        if found:
            lines.append(f"- {document.get('title', 'Single cases')}:")
            lines += [f"  - {point}" for point in found]
    return lines or ["None."]


def summary(folder):
    documents = [json.loads((folder / f"{name}.json").read_text()) for name in maps.NAMES]
    return "\n".join([*table(documents), "", "**A baseline holds and ours does not:**", "",
                      *listed(documents, held_by_baselines_alone), "", "**Ours is worse than no limiter:**", "",
                      *listed(documents, worse_than_none), "", "**Ours gains energy:**", "",
                      *listed(documents, gaining_energy)]) + "\n"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    wanted = parser.add_mutually_exclusive_group(required=True)
    wanted.add_argument("folder", type=Path, nargs="?", help="docs/stability")
    wanted.add_argument("--names", action="store_true", help="what the atlas consists of, a line each")
    options = parser.parse_args()
    print("\n".join(maps.NAMES) + "\n" if options.names else summary(options.folder), end="")
