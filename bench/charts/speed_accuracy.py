#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Area change against the filter's milliseconds per frame, from the summary that speed_accuracy_sweep.py writes."""

import math
import sys

from chart_tools import (COLOURS, FAINT, MARKERS, ChartError, OneLineParser, exit_code_of, new_chart, percent, plain,
                         read_json, save_chart, show_few_decades)
from matplotlib.lines import Line2D

MEASURES = (("max_area_change", "greatest over the run"),
            ("mean_max_area_change", "mean over frames of each frame's greatest"))
WORST_SHOWN = 10.0  # 1000 %: a run beyond it has broken down, whatever its status says


def read_summary(path):
    summary = read_json(path)
    try:
        for run in summary["runs"]:
            float(run["regularization"]), int(run["sub_steps"]), str(run["matrix"])
            for field in (*(name for name, _ in MEASURES), "filter_seconds_per_frame"):
                run[field] = math.nan if run[field] is None else float(run[field])
    except (KeyError, TypeError, ValueError) as error:
        raise ChartError(f"{path}: not a summary of speed_accuracy_sweep.py ({type(error).__name__}: {error})"
                         ) from None
    if not any(drawable(run) for run in summary["runs"]):
        raise ChartError(f"{path}: no run with a finite area change and filter time")
    return summary


def drawable(run):
    return (run.get("status") != "diverged" and 0.0 < run["filter_seconds_per_frame"] < math.inf
            and all(0.0 < run[name] <= WORST_SHOWN for name, _ in MEASURES))


def curves_of(runs):
    """One curve a matrix and α: {(matrix, α): runs by sub-steps}, the consistent matrix first, α falling."""
    curves = {}
    for run in sorted(runs, key=lambda run: (run["matrix"], -run["regularization"], run["sub_steps"])):
        curves.setdefault((run["matrix"], run["regularization"]), []).append(run)
    return curves


def draw(axis, measure, title, curves, markers, without):
    shown = []
    for (key, runs), colour in zip(curves.items(), COLOURS * 9):
        good = [run for run in runs if drawable(run)]
        x = [1e3 * run["filter_seconds_per_frame"] for run in good]
        y = [100.0 * run[measure] for run in good]
        shown += y
        style = "-" if key[0] == "consistent" else "--"
        axis.plot(x, y, style, color=colour, linewidth=1.4)
        for run, at_x, at_y in zip(good, x, y):
            axis.plot(at_x, at_y, markers[run["sub_steps"]], color=colour, markersize=6)
    axis.set_xscale("log")
    axis.set_yscale("log")
    if isinstance(without, (int, float)) and math.isfinite(without) and without > 0.0:
        axis.axhline(100.0 * without, color=FAINT, linestyle=":", linewidth=1.4)
        axis.annotate(f"no filter {percent(without)}", (1.0, 100.0 * without), xycoords=("axes fraction", "data"),
                      xytext=(0, 3), textcoords="offset points", ha="right", color="#666666", fontsize=9)
        shown.append(100.0 * without)
    show_few_decades(axis.yaxis, min(shown), max(shown), " %")
    axis.set_title(title)
    axis.set_xlabel("filter, ms per frame")


def run(arguments):
    parser = OneLineParser(description=__doc__)
    parser.add_argument("summary", metavar="summary.json")
    parser.add_argument("--title", default=None, help="default: scene, triangles and device")
    parser.add_argument("--out", required=True, metavar="FILE.png")
    options = parser.parse_args(arguments)
    summary = read_summary(options.summary)
    curves = curves_of(summary["runs"])
    counts = sorted({run["sub_steps"] for run in summary["runs"]})
    if len(counts) > len(MARKERS) or len(curves) > len(COLOURS):
        raise ChartError(f"{options.summary}: {len(curves)} settings of {len(counts)} sub-step counts; a chart holds "
                         f"at most {len(COLOURS)} of {len(MARKERS)}")
    markers = dict(zip(counts, MARKERS))
    without = summary.get("without_filter") or {}

    figure, axes = new_chart(columns=2, width=8.0, height=4.6, sharex=True)
    for axis, (measure, title) in zip(axes, MEASURES):
        draw(axis, measure, title, curves, markers, without.get(measure))
    times = [1e3 * run["filter_seconds_per_frame"] for run in summary["runs"] if drawable(run)]
    show_few_decades(axes[0].xaxis, min(times), max(times))
    axes[0].set_ylabel("|A − A⁰| / A⁰")
    lines = []
    for (key, runs), colour in zip(curves.items(), COLOURS):
        lost = [str(run["sub_steps"]) for run in runs if not drawable(run)]
        text = f"{key[0]}, α = {plain(key[1])}" + (f" (broke down: {', '.join(lost)})" if lost else "")
        lines.append(Line2D([], [], color=colour, linestyle="-" if key[0] == "consistent" else "--", label=text))
    shapes = [Line2D([], [], color=FAINT, linestyle="", marker=markers[count], label=str(count)) for count in counts]
    axes[0].legend(handles=lines, loc="upper left", bbox_to_anchor=(-0.02, -0.14), ncol=1, fontsize=9)
    axes[1].legend(handles=shapes, loc="upper left", bbox_to_anchor=(-0.02, -0.14), ncol=len(counts), fontsize=9,
                   title="sub-steps a frame", title_fontsize=9, columnspacing=1.0, handletextpad=0.2,
                   alignment="left")
    title = options.title or ", ".join(str(part) for part in (
        summary.get("scene"), f"{summary['triangles']:,} triangles".replace(",", "\N{NO-BREAK SPACE}")
        if isinstance(summary.get("triangles"), int) else None, summary.get("device")) if part)
    figure.suptitle(title, x=0.01, ha="left", fontsize=10.5)
    save_chart(figure, options.out)


if __name__ == "__main__":
    sys.exit(exit_code_of(run))
