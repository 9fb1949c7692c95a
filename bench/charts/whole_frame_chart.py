#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Milliseconds of processor time that a whole frame takes, everything counted, against area change and against stretch, a
row for each scene and a curve a method; from the results of `apsl compare`. Both are greatest values over the frames after
the first ten, times medians over frames. A method's curve is its own front, in each panel for itself; other runs are small
dots."""

import sys

from chart_tools import ChartError, exit_code_of, new_chart
from compare_results import (SETTLED_AREA, SETTLED_EXCESS, held, number, read_results, results_parser, save_comparison,
                             styles)
from pareto_chart import draw

PANELS = {SETTLED_AREA: ("area change", "|A − A⁰| / A⁰"),
          SETTLED_EXCESS: ("principal stretch, above 1", "s₁ − 1")}


def whole_frames(results):
    """Runs that held for more than ten frames, with the whole frame's milliseconds in the place of the limiter's."""
    runs = []
    for run in results["runs"]:
        if SETTLED_EXCESS in run and "frame_processor_seconds" in run:
            runs.append({**run, "milliseconds": 1e3 * number(run["frame_processor_seconds"]["median"])})
    return runs


def run(arguments):
    options = results_parser(__doc__).parse_args(arguments)
    results = read_results(options.results)
    measured = whole_frames(results)
    table = styles(results)
    scenes = {}
    for of_scene in measured:
        if (of_scene["method"] != "none" and held(of_scene) and of_scene["milliseconds"] > 0.0
                and of_scene[SETTLED_AREA] > 0.0 and of_scene[SETTLED_EXCESS] > 0.0):
            scenes.setdefault(of_scene["scene"], []).append(of_scene)
    if not scenes:
        raise ChartError(f"{options.results}: no run with whole frames' times that held for more than ten frames")
    figure, axes = new_chart(rows=len(scenes), columns=2, width=11.0, height=3.6 * len(scenes) + 1.2, squeeze=False)
    for row, (scene, limited) in zip(axes, scenes.items()):
        without = next((run for run in measured if run["scene"] == scene and run["method"] == "none"), None)
        for axis, (error, (title, label)) in zip(row, PANELS.items()):
            draw(axis, error, limited, without, table, f"{limited[0]['triangles']:,} triangles: {title}")
            axis.set_ylabel(label)
            axis.set_xlabel("whole frame, ms of processor time")
    machine = results["machine"]
    save_comparison(figure, list(axes.flat), options.out, machine["processor"])


if __name__ == "__main__":
    sys.exit(exit_code_of(run))
