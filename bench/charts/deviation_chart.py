#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""How far the vertices are from a converged solution of the same scene (small steps, tight tolerance, double
precision), against milliseconds in the limiter; from the results of `apsl compare --deviation`."""

import sys

from chart_tools import ChartError, exit_code_of, new_chart, show_few_decades
from compare_results import by_method, read_results, results_parser, save_comparison, styles


def points_of(runs, place):
    """[(milliseconds, RMS distance in mm at the place-th of the frames)], by time."""
    return sorted((run["milliseconds"], 1e3 * run["deviation"]["frames"][place]["rms"]) for run in runs
                  if len(run["deviation"]["frames"]) > place
                  and run["deviation"]["frames"][place]["rms"] is not None)


def run(arguments):
    options = results_parser(__doc__).parse_args(arguments)
    results = read_results(options.results)
    runs = [run for run in results["runs"] if run.get("deviation") and run["deviation"]["frames"]]
    limited = [run for run in runs if run["method"] != "none" and run["milliseconds"] > 0.0]
    if not limited:
        raise ChartError(f"{options.results}: no run with its deviation measured")
    frames = [at["frame"] for at in limited[0]["deviation"]["frames"]]
    table = styles(results)
    figure, axes = new_chart(columns=len(frames), width=11.0, height=5.0, sharey=True)
    values = []
    for place, (axis, frame) in enumerate(zip([axes] if len(frames) == 1 else axes, frames)):
        for method, own in by_method(limited).items():
            colour, marker, width = table[method]
            for steps in sorted({run["parameters"]["steps_per_frame"] for run in own}):
                points = points_of([run for run in own if run["parameters"]["steps_per_frame"] == steps], place)
                if points:
                    axis.plot(*zip(*points), "-" if steps == 1 else "--", color=colour, marker=marker, markersize=4.5,
                              linewidth=width, label=own[0]["title"] + (f", {steps} steps a frame" if steps > 1 else ""))
                values += [value for _, value in points if value > 0.0]
        without = next((run for run in runs if run["method"] == "none"), None)
        if without:
            level = 1e3 * without["deviation"]["frames"][place]["rms"]
            axis.axhline(level, color="#8a8a8a", linestyle=":", linewidth=1.4, label="no limiter")
            values.append(level)
        axis.set_xscale("log")
        axis.set_yscale("log")
        show_few_decades(axis.xaxis, min(run["milliseconds"] for run in limited),
                         max(run["milliseconds"] for run in limited))
        axis.set_title(f"frame {frame}")
        axis.set_xlabel("limiter, ms per frame")
    first = axes if len(frames) == 1 else axes[0]
    show_few_decades(first.yaxis, min(values), max(values))
    first.set_ylabel("RMS distance from the converged solution, mm")
    save_comparison(figure, [first] if len(frames) == 1 else axes, options.out)


if __name__ == "__main__":
    sys.exit(exit_code_of(run))
