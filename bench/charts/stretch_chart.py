#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Milliseconds in the limiter per frame against area change, and against stretch, one curve a method; from the results of
`apsl compare`. Both are greatest values over the frames after the first ten. A method's curve is its own front over all
its parameters, in each panel for itself; its other runs are small dots."""

import sys

from chart_tools import ChartError, exit_code_of, new_chart
from compare_results import (SETTLED_AREA, SETTLED_EXCESS, held, read_results, results_parser, save_comparison, styles,
                             title_of)
from pareto_chart import draw

PANELS = {SETTLED_AREA: ("greatest area change", "|A − A⁰| / A⁰"),
          SETTLED_EXCESS: ("greatest principal stretch, above 1", "s₁ − 1")}


def run(arguments):
    parser = results_parser(__doc__, scene=True)
    parser.add_argument("--ceiling", type=float, help="a stretch to mark, such as 1.1")
    options = parser.parse_args(arguments)
    results = read_results(options.results)
    of_scene = [run for run in results["runs"] if run["scene"] == options.scene and SETTLED_EXCESS in run]
    limited = [run for run in of_scene if run["method"] != "none" and held(run) and run["milliseconds"] > 0.0
               and run[SETTLED_AREA] > 0.0 and run[SETTLED_EXCESS] > 0.0]
    if not limited:
        raise ChartError(f"{options.results}: no run of scene {options.scene} that held for more than ten frames")
    without = next((run for run in of_scene if run["method"] == "none"), None)
    table = styles(results)
    figure, axes = new_chart(columns=2, width=11.0, height=6.0)
    for axis, (error, (title, label)) in zip(axes, PANELS.items()):
        draw(axis, error, limited, without, table, title)
        axis.set_ylabel(label)
    if options.ceiling:
        axes[1].axhline(100.0 * (options.ceiling - 1.0), color="#5b2be0", linestyle="--", linewidth=1.0)
        axes[1].annotate(f"ceiling {options.ceiling:g}", (0.0, 100.0 * (options.ceiling - 1.0)),
                         xycoords=("axes fraction", "data"), xytext=(2, 3), textcoords="offset points",
                         color="#5b2be0", fontsize=9)
    save_comparison(figure, axes, options.out, title_of(results, options.scene))


if __name__ == "__main__":
    sys.exit(exit_code_of(run))
