#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Greatest area change per frame from `apsl run --report` files: the paper's Fig. 5. The axis is logarithmic, so that
an unfiltered 300 % and a filtered 2 % can both be read."""

import math
import sys

from chart_tools import (COLOURS, ChartError, OneLineParser, exit_code_of, log_axis, new_chart, percent, read_json,
                         save_chart)

def read_curve(path):
    """(frame numbers, greatest area change per frame, status of the run); a value that is not finite becomes NaN."""
    report = read_json(path)
    try:
        frames = report["frames"]
        numbers = [int(frame["frame"]) for frame in frames]
        values = [frame["max_area_change"] for frame in frames]
    except (KeyError, TypeError, ValueError) as error:
        raise ChartError(f"{path}: not a report of `apsl run`: frames[].frame and .max_area_change expected "
                         f"({type(error).__name__}: {error})") from None
    if not numbers:
        raise ChartError(f"{path}: the report holds no frame")
    values = [float(value) if isinstance(value, (int, float)) and math.isfinite(value) else math.nan
              for value in values]
    if all(math.isnan(value) for value in values):
        raise ChartError(f"{path}: max_area_change is not finite in any frame")
    summary = report.get("summary")
    return numbers, values, summary.get("status", "ok") if isinstance(summary, dict) else "ok"


def lowest_shown(values):
    """The decade that all but the lowest twentieth of the values lie above: a cloth at rest in the first frames has
    rounding error alone, which would take up most of the axis."""
    shown = sorted(value for value in values if value > 0.0)
    return 10.0 ** math.floor(math.log10(shown[len(shown) // 20] / 1.5)) if shown else 1e-4


def run(arguments):
    parser = OneLineParser(description=__doc__)
    parser.add_argument("reports", nargs="+", metavar="report.json")
    parser.add_argument("--labels", nargs="+", metavar="TEXT", help="one a report (default: the file names)")
    parser.add_argument("--title", default="Greatest area change per frame")
    parser.add_argument("--out", required=True, metavar="FILE.png")
    options = parser.parse_args(arguments)
    labels = options.labels or options.reports
    if len(labels) != len(options.reports):
        raise ChartError(f"--labels: {len(labels)} given for {len(options.reports)} reports")
    if len(options.reports) > len(COLOURS):
        raise ChartError(f"{len(options.reports)} reports: a chart of more than {len(COLOURS)} curves cannot be read")

    curves = [(*read_curve(path), label) for path, label in zip(options.reports, labels)]
    lowest = lowest_shown([value for _, values, _, _ in curves for value in values])
    figure, axes = new_chart()
    greatest = 0.0
    for (numbers, values, status, label), colour in zip(curves, COLOURS):
        top = max(value for value in values if not math.isnan(value))
        greatest = max(greatest, top)
        text = f"{label}\ngreatest {percent(top)}" + (", broke down" if status == "diverged" else "")
        drawn = [math.nan if math.isnan(value) else 100.0 * max(value, 0.1 * lowest) for value in values]
        axes.plot(numbers, drawn, color=colour, label=text)
    axes.set_yscale("log")
    axes.set_ylim(100.0 * lowest, 160.0 * max(greatest, lowest))
    axes.margins(x=0.01)
    log_axis(axes.yaxis, " %")
    axes.set_xlabel("frame")
    axes.set_ylabel("greatest |A − A⁰| / A⁰")
    axes.set_title(options.title)
    # Beside the axes: inside, it would cover a curve on some run.
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), labelspacing=1.2, handlelength=1.2)
    save_chart(figure, options.out)


if __name__ == "__main__":
    sys.exit(exit_code_of(run))
