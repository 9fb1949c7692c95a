#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What the results of `apsl compare` say about speed against accuracy: tables in Markdown. Expects the studies
curtain_8k, curtain_32k, refinement and front of bench/studies as files of one folder; those of stretch and whole_frame where they are there."""

import sys
from pathlib import Path

from chart_tools import ChartError, OneLineParser, exit_code_of, plain
from compare_results import (SETTLED_AREA, SETTLED_EDGE, SETTLED_EXCESS, front, held, is_ours, read_results, time_at)
from whole_frame_chart import whole_frames

MEAN, GREATEST = "mean_max_area_change", "max_area_change"
LEVELS = (0.3, 0.2, 0.1, 0.05, 0.02, 0.01)
PAPER = {"strain_limiting.sub_steps": 10, "strain_limiting.regularization": 1.2, "strain_limiting.tolerance": 0.1}


def is_paper_setting(run):
    return run["method"] == "apsl" and all(run["parameters"].get(name) == value for name, value in PAPER.items())


def shown(value):
    return f"{plain(round(100.0 * value, 3))} %"


def parameters_of(run):
    return ", ".join(f"{name.split('.')[-1]} {value:g}" for name, value in run["parameters"].items()
                     if isinstance(value, (int, float)) and value > 0 and name.split(".")[-1] not in (
                         "max_iterations", "warm_start_sub_steps", "steps_per_frame", "adaptive_threshold"))


def against_paper(runs):
    """(paper's run, ours with the least mean in no more time and with no greater greatest, ours that is quickest with no
    greater mean and greatest)."""
    paper = next((run for run in runs if is_paper_setting(run)), None)
    if paper is None:
        raise ChartError("no run with the paper's setting")
    ours = [run for run in runs if is_ours(run["method"]) and run[GREATEST] <= paper[GREATEST]]
    best = min((run for run in ours if run["milliseconds"] <= paper["milliseconds"]), key=lambda run: run[MEAN])
    quickest = min((run for run in ours if run[MEAN] <= paper[MEAN]), key=lambda run: run["milliseconds"])
    return paper, best, quickest


def against_baselines(runs):
    """[(error, milliseconds of ours, of the best baseline, its title)], where both reach it."""
    table = []
    for level in LEVELS:
        ours = time_at([run for run in runs if is_ours(run["method"])], MEAN, level)
        baselines = []
        for method in {run["method"] for run in runs if not is_ours(run["method"])}:
            own = [run for run in runs if run["method"] == method]
            at = time_at(own, MEAN, level)
            if at is not None:
                baselines.append((at, own[0]["title"]))
        table.append((level, ours, *(min(baselines) if baselines else (None, "none reaches it"))))
    return table


def size_rows(results, name):
    runs = [run for run in results["runs"] if run["method"] != "none" and held(run) and run["milliseconds"] > 0.0]
    paper, best, quickest = against_paper(runs)
    rows = [f"| {name}: mean of each frame's greatest, in the time of the paper's setting ({plain(paper['milliseconds'])}"
            f" ms) | a third of {shown(paper[MEAN])} | {shown(best[MEAN])}, {plain(paper[MEAN] / best[MEAN])} times less "
            f"({best['title']}: {parameters_of(best)}) |",
            f"| {name}: greatest | ≤ {shown(paper[GREATEST])} | {shown(best[GREATEST])} |",
            f"| {name}: time for the paper's error | a third of {plain(paper['milliseconds'])} ms | "
            f"{plain(quickest['milliseconds'])} ms, {plain(paper['milliseconds'] / quickest['milliseconds'])} times less "
            f"({quickest['title']}: {parameters_of(quickest)}) |"]
    least = min((run for run in runs if is_ours(run["method"])), key=lambda run: run[MEAN])
    rows.append(f"| {name}: 0.1 % | reachable | {shown(least[MEAN])} (greatest {shown(least[GREATEST])}) at "
                f"{plain(least['milliseconds'])} ms ({least['title']}: {parameters_of(least)}) |")
    for level, ours, baseline, title in against_baselines(runs):
        if ours is None and baseline is None:
            continue
        asked = "3×" if "8 k" in name else "5×"
        reached = ("ours does not reach it" if ours is None else f"ours {plain(ours)} ms, none of the others"
                   if baseline is None else f"{plain(baseline / ours)}× ({plain(ours)} ms, {title} {plain(baseline)} ms)")
        rows.append(f"| {name}: faster than the best baseline at {shown(level)} | {asked} | {reached} |")
    return rows


def growth_row(results, target, of="ours", chosen=is_ours):
    runs = [run for run in results["runs"] if chosen(run["method"]) and held(run)]
    per_triangle = {}
    for size in sorted({run["triangles"] for run in runs}):
        at = time_at([run for run in runs if run["triangles"] == size], MEAN, target)
        if at is not None:
            per_triangle[size] = 1e3 * at / size
    text = ", ".join(f"{plain(size)}: {plain(value)} µs" for size, value in per_triangle.items())
    text = text or "no size reaches it"
    return f"| time a triangle of {of} to reach {shown(target)}, 2 k to 130 k triangles | grows by less than 2× | {text} |"


def in_short(run):
    """A run of ours by its sub-steps and α, others by all parameters."""
    parameters = run["parameters"]
    last, count = parameters.get("strain_limiting.regularization"), parameters.get("strain_limiting.sub_steps")
    if not is_ours(run["method"]) or last is None or count is None:
        return f"{run['title']}: {parameters_of(run)}"
    first = parameters.get("strain_limiting.first_regularization")
    alpha = f"{first:g} → {last:g}" if first else f"{last:g}"
    period = parameters.get("strain_limiting.bound_interval")
    bound = "" if period is None else ", one bound" if period >= count else f", a bound for {period:g}"
    return f"{run['title'].removeprefix('Area preserving').removeprefix(', ') or 'as the paper'}: {alpha}, {count}{bound}"


def front_rows(results):
    """Every run of the study against the paper's setting on the same scene: errors, iterations, time as a ratio."""
    rows = ["| | α, sub-steps | mean | greatest | CG iterations a frame | time |", "|---|---|---|---|---|---|"]
    for scene in dict.fromkeys(run["scene"] for run in results["runs"]):
        runs = [run for run in results["runs"] if run["scene"] == scene and held(run)]
        paper = next((run for run in runs if is_paper_setting(run)), None)
        if paper is None:
            raise ChartError(f"{scene}: no run with the paper's setting")
        for run in [paper, *(run for run in runs if run is not paper and run["method"] != "none")]:
            setting = "the paper's: 1.2, 10" if run is paper else in_short(run)
            iterations = run["iterations_per_solve"] * run["solves"] / run["frames"] if run["solves"] else None
            rows.append(f"| {scene} | {setting} | {shown(run[MEAN])} | {shown(run[GREATEST])} | "
                        f"{'–' if iterations is None else round(iterations)} | "
                        f"{run['milliseconds'] / paper['milliseconds']:.2f} |")
    return rows


WORST_LISTED = 0.2  # of both: what no other beats may be quick and hold nothing


def greatest_of_both(run):
    return max(run[SETTLED_AREA], run[SETTLED_EXCESS])


def unbeaten(runs):
    """Of runs, those that no other beats in time, area change and stretch at once."""
    def as_good(other, run):
        return all(other[field] <= run[field] for field in ("milliseconds", SETTLED_AREA, SETTLED_EXCESS))
    return [run for run in runs if not any(other is not run and as_good(other, run) for other in runs)]


def with_steps(run):
    steps = run["parameters"]["steps_per_frame"]
    if is_ours(run["method"]):
        ceiling = run["parameters"].get("strain_limiting.stretch_ceiling")
        count = run["parameters"].get("strain_limiting.sub_steps")
        setting = "the defaults" if ceiling is None else f"ceiling {ceiling:g}, {count} sub-steps"
    else:
        named = parameters_of(run)
        setting = f"{run['title']}: {named}" if named else run["title"]
    return setting, str(steps)


def stretch_rows(results):
    """Who holds what: without a limiter, ours, of each other method the run with the least of both, and what no other beats.
    Times as a ratio to the defaults'."""
    runs = [run for run in results["runs"] if held(run) and SETTLED_EXCESS in run]
    defaults = next((run for run in runs if run["method"] == "apsl_defaults"), None)
    if defaults is None:
        raise ChartError("no run of apsl_defaults")
    limited = [run for run in runs if run["method"] != "none" and run["milliseconds"] > 0.0]
    best = {method: min((run for run in limited if run["method"] == method), key=greatest_of_both)
            for method in dict.fromkeys(run["method"] for run in limited)}
    front_runs = unbeaten(limited)
    chosen = [run for run in limited if is_ours(run["method"]) or run is best[run["method"]]
              or (run in front_runs and greatest_of_both(run) <= WORST_LISTED)]
    without = [run for run in runs if run["method"] == "none" and run["parameters"]["steps_per_frame"] == 1]
    rows = ["| method | steps a frame | area change | edges | principal stretch | time | unbeaten |",
            "|---|---|---|---|---|---|---|"]
    for run in [*without, *sorted(chosen, key=lambda run: (not is_ours(run["method"]), greatest_of_both(run)))]:
        setting, steps = with_steps(run)
        time = f"{run['milliseconds'] / defaults['milliseconds']:.2f}" if run["method"] != "none" else "–"
        rows.append(f"| {setting} | {steps} | {shown(run[SETTLED_AREA])} | {1.0 + run[SETTLED_EDGE]:.3f} | "
                    f"{1.0 + run[SETTLED_EXCESS]:.3f} | {time} | {'yes' if run in front_runs else 'no'} |")
    return rows


def whole_frame_rows(results):
    """Every run with its whole frame's milliseconds of processor time."""
    runs = whole_frames(results)
    rows = ["| | method | area change | edges | principal stretch | ms a frame |", "|---|---|---|---|---|---|"]
    for scene in dict.fromkeys(run["scene"] for run in runs):
        for run in (run for run in runs if run["scene"] == scene and held(run)):
            count = run["parameters"].get("small_steps", run["parameters"].get("strain_limiting.sub_steps"))
            alpha = run["parameters"].get("strain_limiting.regularization")
            setting = run["title"] + (f", {count}" if count is not None else "") + (f", α {alpha:g}" if alpha else "")
            rows.append(f"| {scene} | {setting} | {shown(run[SETTLED_AREA])} | {1.0 + run[SETTLED_EDGE]:.3f} | "
                        f"{1.0 + run[SETTLED_EXCESS]:.3f} | {plain(run['milliseconds'])} |")
    return rows


def run(arguments):
    parser = OneLineParser(description=__doc__)
    parser.add_argument("folder", nargs="?", default="docs/accuracy", type=Path)
    parser.add_argument("--target", type=float, default=0.1)
    options = parser.parse_args(arguments)
    rows = ["| | target | measured |", "|---|---|---|"]
    for file, name in (("curtain_8k", "8 k"), ("curtain_32k", "32 k")):
        rows += size_rows(read_results(options.folder / f"{file}.json"), name)
    refinement = read_results(options.folder / "refinement.json")
    for target in (options.target, 2.0 * options.target):
        rows.append(growth_row(refinement, target))
        rows.append(growth_row(refinement, target, "small steps alone", lambda method: method == "apsl_small_steps"))
    rows += ["", *front_rows(read_results(options.folder / "front.json"))]
    stretch = options.folder / "stretch.json"
    if stretch.exists():
        rows += ["", *stretch_rows(read_results(stretch))]
    whole_frame = options.folder / "whole_frame.json"
    if whole_frame.exists():
        rows += ["", *whole_frame_rows(read_results(whole_frame))]
    print("\n".join(rows))


if __name__ == "__main__":
    sys.exit(exit_code_of(run))
