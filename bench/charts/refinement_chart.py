#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What happens as the mesh is refined: the area change a method leaves in a fixed time a triangle, and the time a
triangle it needs for a fixed area change. From the results of `apsl compare` on scenes that differ in their grid."""

import sys

from chart_tools import ChartError, exit_code_of, new_chart, plain, show_few_decades
from compare_results import by_method, front, held, read_results, results_parser, save_comparison, styles, time_at

ERROR = "mean_max_area_change"


def error_within(runs, milliseconds):
    affordable = [run for run in front(runs, ERROR) if run["milliseconds"] <= milliseconds]
    return affordable[-1][ERROR] if affordable else None


def run(arguments):
    parser = results_parser(__doc__)
    parser.add_argument("--microseconds", type=float, default=1.0, help="in the limiter, a frame and triangle")
    parser.add_argument("--target", type=float, default=0.05, help="mean over frames of each frame's greatest")
    options = parser.parse_args(arguments)
    results = read_results(options.results)
    table = styles(results)
    runs = [run for run in results["runs"] if run["method"] != "none" and held(run) and run["milliseconds"] > 0.0]
    if not runs:
        raise ChartError(f"{options.results}: no run that held")
    figure, axes = new_chart(columns=2, width=11.0, height=5.2)
    errors, times, sizes = [], [], sorted({run["triangles"] for run in runs})
    for method, own in by_method(runs).items():
        colour, marker, width = table[method]
        style = dict(color=colour, marker=marker, markersize=4.5, linewidth=width, label=own[0]["title"])
        at = {size: [run for run in own if run["triangles"] == size] for size in sizes}
        left = [(size, error_within(at[size], 1e-3 * options.microseconds * size)) for size in sizes]
        left = [(size, 100.0 * value) for size, value in left if value is not None]
        needed = [(size, time_at(at[size], ERROR, options.target)) for size in sizes]
        needed = [(size, 1e3 * value / size) for size, value in needed if value is not None]
        if left:
            axes[0].plot(*zip(*left), **style)
        if needed:
            axes[1].plot(*zip(*needed), **style)
        errors += [value for _, value in left]
        times += [value for _, value in needed]
    if not errors or not times:
        raise ChartError(f"{options.results}: nothing within {options.microseconds} µs, or nothing that reaches "
                         f"{options.target}")
    for axis in axes:
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_xlabel("triangles")
        show_few_decades(axis.xaxis, min(sizes), max(sizes))
    show_few_decades(axes[0].yaxis, min(errors), max(errors), " %")
    show_few_decades(axes[1].yaxis, min(times), max(times))
    axes[0].set_title(f"area change left in {plain(options.microseconds)} µs a triangle and frame")
    axes[0].set_ylabel("mean of each frame's greatest |A − A⁰| / A⁰")
    axes[1].set_title(f"time to reach {plain(100.0 * options.target)} %")
    axes[1].set_ylabel("µs a triangle and frame")
    machine = results["machine"]
    save_comparison(figure, axes, options.out, f"Curtain, finer and finer; {machine['processor']}, {machine['cores']} cores")


if __name__ == "__main__":
    sys.exit(exit_code_of(run))
