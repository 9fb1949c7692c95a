#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Greatest area change against how often a method passes over the cloth in a frame: iterations of the local methods,
sub-steps of ours. From the results of `apsl compare`."""

import sys

from chart_tools import ChartError, exit_code_of, new_chart, show_few_decades
from compare_results import by_method, held, read_results, results_parser, save_comparison, styles, title_of

PASSES = ("iterations", "strain_limiting.sub_steps")


def passes_of(run):
    name = next((name for name in PASSES if name in run["parameters"]), None)
    return None if name is None else float(run["parameters"][name]) * float(run["parameters"].get("steps_per_frame", 1))


def lowest_by_passes(runs, error):
    """Over all its other parameters a method's least error at each number of passes."""
    lowest = {}
    for run in runs:
        passes = passes_of(run)
        if passes:
            lowest[passes] = min(run[error], lowest.get(passes, run[error]))
    return sorted(lowest.items())


def run(arguments):
    options = results_parser(__doc__, scene=True).parse_args(arguments)
    results = read_results(options.results)
    runs = [run for run in results["runs"] if run["scene"] == options.scene and held(run)]
    table = styles(results)
    figure, axes = new_chart(columns=2, width=11.0, height=5.4, sharey=True)
    shown = []
    for axis, error, title in zip(axes, ("max_area_change", "mean_max_area_change"),
                                  ("greatest over the run", "mean over frames of each frame's greatest")):
        for method, own in by_method(runs).items():
            points = lowest_by_passes(own, error)
            if len(points) < 2:
                continue
            colour, marker, width = table[method]
            axis.plot([at for at, _ in points], [100.0 * value for _, value in points], color=colour, marker=marker,
                      markersize=4.5, linewidth=width, label=own[0]["title"])
            shown += [100.0 * value for _, value in points]
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_title(title)
        axis.set_xlabel("iterations (local methods) or sub-steps (ours) a frame")
    if not shown:
        raise ChartError(f"{options.results}: no method of scene {options.scene} held at two numbers of passes")
    show_few_decades(axes[0].yaxis, min(shown), max(shown), " %")
    for axis in axes:
        show_few_decades(axis.xaxis, 1.0, 1000.0)
    axes[0].set_ylabel("|A − A⁰| / A⁰")
    save_comparison(figure, axes, options.out, title_of(results, options.scene))


if __name__ == "__main__":
    sys.exit(exit_code_of(run))
