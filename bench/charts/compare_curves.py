#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Greatest area change per frame, one curve a method: the paper's Fig. 5 for all of them. From the results of
`apsl compare` of a study with "keep_frames". Of a method with several runs the most accurate of those within
--milliseconds is drawn, or its quickest where none is."""

import sys

from chart_tools import ChartError, exit_code_of, new_chart, plain, show_few_decades
from compare_results import by_method, read_results, results_parser, save_comparison, styles, title_of


def choose(runs, milliseconds):
    """The run with the least mean error of those within the time; the quickest where none is."""
    within = [run for run in runs if run["milliseconds"] <= milliseconds]
    return min(within, key=lambda run: run["mean_max_area_change"]) if within else min(
        runs, key=lambda run: run["milliseconds"])


def run(arguments):
    parser = results_parser(__doc__, scene=True)
    parser.add_argument("--milliseconds", type=float, default=5.0, help="in the limiter, a frame")
    options = parser.parse_args(arguments)
    results = read_results(options.results)
    runs = [run for run in results["runs"] if run["scene"] == options.scene and run.get("frame_max_area_change")]
    if not runs:
        raise ChartError(f"{options.results}: no run of scene {options.scene} that kept its frames")
    table = styles(results)
    figure, axis = new_chart(width=11.0, height=5.6)
    shown = []
    for method, own in by_method(runs).items():
        chosen = choose(own, options.milliseconds)
        curve = [100.0 * value if value else float("nan") for value in chosen["frame_max_area_change"]]
        colour, marker, width = ("#8a8a8a", "", 1.6) if method == "none" else table[method]
        late = "" if chosen["milliseconds"] <= options.milliseconds else f" ({plain(chosen['milliseconds'])} ms)"
        axis.plot(range(len(curve)), curve, color=colour, marker=marker, markevery=max(len(curve) // 12, 1),
                  markersize=4, linewidth=width, label=chosen["title"] + late)
        shown += [value for value in curve if 0.0 < value <= 1000.0]
    axis.set_yscale("log")
    axis.set_ylim(max(min(shown), 1e-3), 1.2 * max(shown))
    show_few_decades(axis.yaxis, min(shown), max(shown), " %")
    axis.set_xlabel("frame")
    axis.set_ylabel("greatest |A − A⁰| / A⁰")
    save_comparison(figure, [axis], options.out,
                    f"{title_of(results, options.scene)}, at most {plain(options.milliseconds)} ms a frame in the limiter")


if __name__ == "__main__":
    sys.exit(exit_code_of(run))
