#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws benchmark results (docs/benchmark.schema.json): time against size for ours and for peers, each kernel's share
of copy bandwidth, and what a filter call spends its time on. A chart without data is left out, and said so."""

import math
import sys
from pathlib import Path

from chart_tools import (COLOURS, FAINT, INK, MARKERS, ChartError, OneLineParser, exit_code_of, new_chart, plain,
                         read_json, save_chart, show_few_decades)

TEXTS = ("commit", "device", "driver", "build_type", "quantity", "method")
NUMBERS = ("triangles", "threads", "median_seconds", "spread")
NUMBERS_OR_NULL = ("bytes_moved", "gb_per_second", "copy_gb_per_second", "error")


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value) and value >= 0.0


def read_results(path):
    """The measurements of one file, checked as far as the charts rely on them."""
    results = read_json(path)
    if not isinstance(results, list):
        raise ChartError(f"{path}: expected a list of measurements, see docs/benchmark.schema.json")
    for place, result in enumerate(results):
        where = f"{path}: measurement {place}"
        if not isinstance(result, dict):
            raise ChartError(f"{where}: expected an object")
        for field in TEXTS:
            if not isinstance(result.get(field), str):
                raise ChartError(f"{where}: {field}: expected text, found {result.get(field)!r}")
        for field in NUMBERS:
            if not is_number(result.get(field)):
                raise ChartError(f"{where}: {field}: expected a number from 0 up, found {result.get(field)!r}")
        for field in NUMBERS_OR_NULL:
            if result.get(field) is not None and not is_number(result[field]):
                raise ChartError(f"{where}: {field}: expected a number from 0 up or null, found {result[field]!r}")
        for field in ("triangles", "median_seconds"):
            if result[field] == 0:
                raise ChartError(f"{where}: {field}: expected more than 0")
        if result["quantity"] not in ("kernel", "cg_iteration", "filter_call", "phase"):
            raise ChartError(f"{where}: quantity: expected kernel, cg_iteration, filter_call or phase, found "
                             f"{result['quantity']!r}")
        if result["quantity"] in ("kernel", "phase") and not isinstance(result.get("name"), str):
            raise ChartError(f"{where}: name: expected the {result['quantity']}, found {result.get('name')!r}")
    return results


def of_quantity(results, quantity):
    return [result for result in results if result["quantity"] == quantity]


def spaced(count):
    return f"{count:,}".replace(",", "\N{NO-BREAK SPACE}")


def method_label(results):
    """The method's name, with its greatest error: a time alone says nothing about a method that gets it wrong."""
    errors = [result["error"] for result in results if result.get("error") is not None]
    return results[0]["method"] + (f", error ≤ {max(errors):.0e}" if errors else "")


def colours_by_method(results):
    """One colour and marker a method, the same in every chart."""
    methods = list(dict.fromkeys(result["method"] for result in results))
    if len(methods) > len(COLOURS):
        raise ChartError(f"{len(methods)} methods: a chart of more than {len(COLOURS)} cannot be read; see --methods")
    return {method: (colour, marker) for method, colour, marker in zip(methods, COLOURS, MARKERS)}


def draw_times(results, styles, subtitle, path):
    """Time per CG iteration and per filter call against the number of triangles, one curve a method."""
    panels = [(quantity, title) for quantity, title in (("cg_iteration", "one CG iteration"),
                                                        ("filter_call", "one filter call"))
              if of_quantity(results, quantity)]
    if not panels:
        return False
    figure, axes = new_chart(columns=len(panels), width=8.0, height=4.4, squeeze=False)
    for axis, (quantity, title) in zip(axes[0], panels):
        times, sizes = [], []
        for method, (colour, marker) in styles.items():
            mine = sorted((result for result in of_quantity(results, quantity) if result["method"] == method),
                          key=lambda result: result["triangles"])
            if not mine:
                continue
            x = [result["triangles"] for result in mine]
            y = [1e3 * result["median_seconds"] for result in mine]
            half = [0.5e3 * result["spread"] for result in mine]
            # A spread as wide as the median itself would reach below zero, which a logarithmic axis has not.
            below = [min(part, 0.9 * value) for part, value in zip(half, y)]
            axis.errorbar(x, y, yerr=[below, half], color=colour, marker=marker, markersize=5, capsize=2,
                          elinewidth=1.0, label=method_label(mine))
            times += y
            sizes += x
        axis.set_xscale("log")
        axis.set_yscale("log")
        show_few_decades(axis.xaxis, min(sizes), max(sizes))
        show_few_decades(axis.yaxis, min(times), max(times))
        axis.set_title(title)
        axis.set_xlabel("triangles")
        axis.legend(loc="upper left", bbox_to_anchor=(-0.02, -0.14), fontsize=9, handlelength=1.5)
    axes[0][0].set_ylabel("median time, ms")
    figure.suptitle(subtitle, x=0.01, ha="left", fontsize=9, color="#555555")
    save_chart(figure, path)
    return True


def share_of_copy(result):
    """Bandwidth over the device's copy bandwidth; None where one of them was not measured."""
    if result["bytes_moved"] is None or not result["copy_gb_per_second"]:
        return None
    return 1e-9 * result["bytes_moved"] / result["median_seconds"] / result["copy_gb_per_second"]


def draw_bandwidth(results, subtitle, path):
    """Each kernel's share of copy bandwidth at its largest size, best on top."""
    largest = {}
    for result in of_quantity(results, "kernel"):
        if share_of_copy(result) is not None:
            best = largest.get(result["name"])
            if best is None or result["triangles"] > best["triangles"]:
                largest[result["name"]] = result
    if not largest:
        return False
    rows = sorted(largest.values(), key=share_of_copy)
    figure, axis = new_chart(width=8.0, height=1.3 + 0.34 * len(rows))
    shares = [100.0 * share_of_copy(result) for result in rows]
    axis.barh(range(len(rows)), shares, color=COLOURS[0], height=0.62)
    for place, (share, result) in enumerate(zip(shares, rows)):
        axis.annotate(f"{share:.0f} %, {plain(1e3 * result['median_seconds'])} ms", (share, place), xytext=(4, 0),
                      textcoords="offset points", va="center", fontsize=9, color=INK,
                      bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0})
    axis.set_yticks(range(len(rows)), [result["name"] for result in rows])
    axis.axvline(100.0, color=FAINT, linewidth=1.2)
    axis.set_xlim(0.0, 1.3 * max(100.0, *shares))
    axis.grid(visible=False, axis="y")
    axis.tick_params(axis="y", length=0)
    sizes = sorted({result["triangles"] for result in rows})
    copy = max(result["copy_gb_per_second"] for result in rows)
    axis.set_xlabel(f"share of copy bandwidth ({plain(copy)} GB/s), %; "
                    f"{' to '.join(spaced(size) for size in dict.fromkeys((sizes[0], sizes[-1])))} triangles")
    axis.set_title(subtitle, fontsize=9, color="#555555")
    save_chart(figure, path)
    return True


def draw_breakdown(results, triangles, subtitle, path):
    """What one filter call spends its time on, one stacked bar a method, at one size."""
    phases = of_quantity(results, "phase")
    if not phases:
        return False
    sizes = {result["triangles"] for result in phases}
    size = triangles or max(sizes)
    if size not in sizes:
        raise ChartError(f"--triangles {size}: no phase was measured at that size; there are "
                         f"{', '.join(map(str, sorted(sizes)))}")
    phases = [result for result in phases if result["triangles"] == size]
    names = list(dict.fromkeys(result["name"] for result in phases))
    if len(names) > len(COLOURS):
        raise ChartError(f"{len(names)} phases: a chart of more than {len(COLOURS)} cannot be read")
    methods = list(dict.fromkeys(result["method"] for result in phases))
    figure, axis = new_chart(width=8.0, height=1.7 + 0.5 * len(methods))
    ends = [0.0] * len(methods)
    for name, colour in zip(names, COLOURS):
        widths = [1e3 * sum(result["median_seconds"] for result in phases
                            if result["name"] == name and result["method"] == method) for method in methods]
        axis.barh(range(len(methods)), widths, left=ends, color=colour, height=0.55, label=name, edgecolor="white")
        ends = [end + width for end, width in zip(ends, widths)]
    for place, end in enumerate(ends):
        axis.annotate(f"{plain(end)} ms", (end, place), xytext=(4, 0), textcoords="offset points", va="center",
                      fontsize=9)
    axis.set_yticks(range(len(methods)), methods)
    axis.invert_yaxis()
    axis.set_xlim(0.0, 1.15 * max(ends))
    axis.grid(visible=False, axis="y")
    axis.tick_params(axis="y", length=0)
    axis.set_xlabel(f"time in one filter call, ms; {spaced(size)} triangles")
    axis.legend(loc="lower left", bbox_to_anchor=(-0.01, 1.0), ncol=min(4, len(names)), fontsize=9, columnspacing=1.2,
                handlelength=1.0)
    figure.suptitle(subtitle, x=0.01, ha="left", fontsize=9, color="#555555")
    save_chart(figure, path)
    return True


def choose(results, device, methods):
    """The measurements to draw. One method measured on two devices is never one curve: that must be asked for."""
    if device == "all":
        results = [{**result, "method": f"{result['method']} ({result['device']})"} for result in results]
    elif device is not None:
        results = [result for result in results if device in result["device"]]
    if methods:
        results = [result for result in results if result["method"] in methods]
    if not results:
        raise ChartError("no measurement left to draw")
    devices = {}
    for result in results:
        devices.setdefault(result["method"], {})[result["device"]] = None
    for method, names in devices.items():
        if len(names) > 1:
            raise ChartError(f"{method} was measured on {len(names)} devices ({', '.join(names)}): choose with "
                             "--device, or --device all")
    return results


def run(arguments):
    parser = OneLineParser(description=__doc__)
    parser.add_argument("results", nargs="+", metavar="results.json")
    parser.add_argument("--device", help="part of the device's name, or all")
    parser.add_argument("--methods", nargs="+", help="draw these alone")
    parser.add_argument("--triangles", type=int, help="size of the cost breakdown (default: the largest)")
    parser.add_argument("--out", required=True, metavar="DIR")
    options = parser.parse_args(arguments)
    results = choose([result for path in options.results for result in read_results(path)], options.device,
                     options.methods)
    styles = colours_by_method([result for result in results if result["quantity"] in ("cg_iteration", "filter_call")])
    facts = [", ".join(dict.fromkeys(str(result[field]) for result in results))
             for field in ("device", "threads", "build_type", "commit")]
    subtitle = f"{facts[0]}; threads {facts[1]}; {facts[2]}; commit {facts[3]}"
    out = Path(options.out)
    drawn = {"time_against_size.png": draw_times(results, styles, subtitle, out / "time_against_size.png"),
             "copy_bandwidth.png": draw_bandwidth(results, subtitle, out / "copy_bandwidth.png"),
             "cost_breakdown.png": draw_breakdown(results, options.triangles, subtitle, out / "cost_breakdown.png")}
    for name, done in drawn.items():
        if not done:
            print(f"warning: {name} left out: no measurement for it", file=sys.stderr)
    if not any(drawn.values()):
        raise ChartError("nothing to draw: no cg_iteration, filter_call, phase, or kernel with bytes_moved and "
                         "copy_gb_per_second")


if __name__ == "__main__":
    sys.exit(exit_code_of(run))
