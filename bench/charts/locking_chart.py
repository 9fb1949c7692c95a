#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""How much a limiter stiffens a cloth where it should not: how far the cloth gives way with it, as a share of how far it
does without (100 %: nothing added, 0 %: locked). From the results of `apsl compare`, where every scene was run with
the method `none` too."""

import math
import sys

from chart_tools import ChartError, exit_code_of, new_chart, save_chart
from compare_results import WIDE_DOTS_PER_INCH, by_method, is_ours, read_results, results_parser


def length(run):
    return math.sqrt(sum(float(component) ** 2 for component in run["mean_displacement"]))


def by_setting(runs):
    """{(method, label): its runs}: a method with several values of a parameter has several labels."""
    settings = {}
    for method, own in by_method(runs).items():
        values = {}
        for run in own:
            for name, value in run["parameters"].items():
                values.setdefault(name, set()).add(value)
        varied = [name for name in values if len(values[name]) > 1]
        for run in own:
            label = " ".join([run["title"], *(f"{run['parameters'][name]:g}" for name in varied)])
            settings.setdefault((method, label), []).append(run)
    return settings


def shares_of(runs, scenes):
    """{(method, label): [share of the displacement without a limiter, for each scene; None where it did not hold]}."""
    table = {}
    for (method, label), own in by_setting(runs).items():
        if method == "none":
            continue
        shares = []
        for scene in scenes:
            without = next((run for run in runs if run["scene"] == scene and run["method"] == "none"), None)
            if without is None or not length(without) > 0.0:
                raise ChartError(f"scene {scene} has no run of the method none that moves")
            run = next((run for run in own if run["scene"] == scene and run["status"] not in ("diverged", "timed_out")),
                       None)
            shares.append(None if run is None else length(run) / length(without))
        table[method, label] = shares
    return table


def run(arguments):
    options = results_parser(__doc__).parse_args(arguments)
    results = read_results(options.results)
    scenes = [scene["name"] for scene in results["scenes"]]
    try:
        table = shares_of(results["runs"], scenes)
    except (KeyError, TypeError, ValueError) as error:
        raise ChartError(f"{options.results}: no displacements ({type(error).__name__}: {error})") from None
    if not table:
        raise ChartError(f"{options.results}: no method but none")
    settings = sorted(table, key=lambda setting: not is_ours(setting[0]), reverse=True)
    figure, axes = new_chart(columns=len(scenes), width=3.0 + 1.9 * len(scenes), height=0.9 + 0.24 * len(settings),
                             sharey=True)
    for axis, scene, place in zip([axes] if len(scenes) == 1 else axes, scenes, range(len(scenes))):
        for row, setting in enumerate(settings):
            share = table[setting][place]
            if share is None:
                axis.annotate("diverged", (0.0, row), xytext=(3, 0), textcoords="offset points", va="center",
                              fontsize=8, color="#666666")
                continue
            axis.barh(row, 100.0 * min(share, 2.0), height=0.7,
                      color="#0072B2" if is_ours(setting[0]) else "#D55E00")
            axis.annotate(f"{100.0 * share:.0f}", (100.0 * min(share, 2.0), row), xytext=(3, 0),
                          textcoords="offset points", va="center", fontsize=8)
        axis.axvline(100.0, color="#8a8a8a", linestyle=":", linewidth=1.4)
        axis.set_title(scene.replace("_", ", "), fontsize=9.5)
        axis.set_xlim(0.0, 150.0)
        axis.grid(False, axis="y")
        axis.set_xlabel("% of the way without")
        axis.set_yticks(range(len(settings)), [label for _, label in settings], fontsize=8.5)
    save_chart(figure, options.out, WIDE_DOTS_PER_INCH)


if __name__ == "__main__":
    sys.exit(exit_code_of(run))
