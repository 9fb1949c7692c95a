#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Milliseconds in the limiter per frame against area change, one curve a method, the Pareto front marked; from the
results of `apsl compare`. A method's curve is its own front over all its parameters; its other runs are small dots."""

import sys

from chart_tools import ChartError, exit_code_of, new_chart, percent, show_few_decades
from compare_results import by_method, front, held, read_results, results_parser, save_comparison, styles, title_of

MEASURES = {"max_area_change": "greatest over the run",
            "mean_max_area_change": "mean over frames of each frame's greatest"}


def draw(axis, error, runs, without, table, title):
    for method, own in by_method(runs).items():
        colour, marker, width = table[method]
        axis.plot([run["milliseconds"] for run in own], [100.0 * run[error] for run in own], ".", color=colour,
                  markersize=2.5, alpha=0.5)
        best = front(own, error)
        axis.plot([run["milliseconds"] for run in best], [100.0 * run[error] for run in best], "-", color=colour,
                  marker=marker, markersize=4.5, linewidth=width, label=own[0]["title"])
    best = front(runs, error)
    axis.plot([run["milliseconds"] for run in best], [100.0 * run[error] for run in best], "o", markersize=10,
              markerfacecolor="none", markeredgecolor="#222222", markeredgewidth=0.9, label="Pareto front")
    shown = [100.0 * run[error] for run in runs]
    if without:
        axis.axhline(100.0 * without[error], color="#8a8a8a", linestyle=":", linewidth=1.4)
        axis.annotate(f"no limiter {percent(without[error])}", (1.0, 100.0 * without[error]),
                      xycoords=("axes fraction", "data"), xytext=(0, 3), textcoords="offset points", ha="right",
                      color="#666666", fontsize=9)
        shown.append(100.0 * without[error])
    axis.set_xscale("log")
    axis.set_yscale("log")
    show_few_decades(axis.yaxis, min(shown), max(shown), " %")
    show_few_decades(axis.xaxis, min(run["milliseconds"] for run in runs), max(run["milliseconds"] for run in runs))
    axis.set_xlabel("limiter, ms per frame")
    axis.set_title(title)


def run(arguments):
    options = results_parser(__doc__, scene=True).parse_args(arguments)
    results = read_results(options.results)
    of_scene = [run for run in results["runs"] if run["scene"] == options.scene]
    limited = [run for run in of_scene if run["method"] != "none" and held(run) and run["milliseconds"] > 0.0]
    if not limited:
        raise ChartError(f"{options.results}: no run of scene {options.scene} that held")
    without = next((run for run in of_scene if run["method"] == "none"), None)
    table = styles(results)
    figure, axes = new_chart(columns=2, width=11.0, height=5.6)
    for axis, error in zip(axes, MEASURES):
        draw(axis, error, limited, without, table, MEASURES[error])
    axes[0].set_ylabel("|A − A⁰| / A⁰")
    save_comparison(figure, axes, options.out, title_of(results, options.scene))


if __name__ == "__main__":
    sys.exit(exit_code_of(run))
