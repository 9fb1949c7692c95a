#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws one map of the atlas of failure, or its single cases, from bench/stability/measure.py's results: a panel for
each method, a square for each point."""

import sys

from chart_tools import ChartError, OneLineParser, exit_code_of, new_chart, plain, read_json, save_chart
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

# Told apart by colour-blind eyes and in print by how dark they are.
COLOURS = {"h": "#56B4E9", "s": "#009E73", "i": "#F0E442", "w": "#E69F00", "g": "#AA4499", "d": "#222222", "t": "#bbbbbb"}
TITLES = {"apsl_defaults": "Ours, the defaults", "apsl": "Ours, the paper's setting",
          "apsl_printed": "Ours, matrix as printed", "apsl_ceiling": "Ours, stretch ceiling"}
SHORT = {"h": "held", "s": "stretched: beyond the ceiling", "i": "inaccurate: above 10 %",
         "w": "worse than no limiter", "g": "gained energy", "d": "diverged", "t": "not finished"}


def squares(axis, rows):
    """Letters as colours, the first row at the bottom."""
    letters = list(COLOURS)
    axis.imshow([[letters.index(letter) for letter in row] for row in rows], cmap=ListedColormap(COLOURS.values()),
                vmin=-0.5, vmax=len(letters) - 0.5, origin="lower", aspect="auto", interpolation="nearest")
    axis.grid(False)
    for edge in range(1, len(rows)):
        axis.axhline(edge - 0.5, color="white", linewidth=0.6)
    for edge in range(1, len(rows[0])):
        axis.axvline(edge - 0.5, color="white", linewidth=0.6)
    axis.tick_params(length=0)


def dots(axis, rows, not_ok):
    """A dot where the limiter itself said that something was wrong."""
    points = [(x, y) for y, row in enumerate(not_ok) for x in row if rows[y][x] != "d"]
    if points:
        axis.scatter(*zip(*points), s=5, color="#222222", linewidths=0)


def legend(figure, document, place, below=0.0):
    """`below`: inches off the figure's edge."""
    used = set("".join(row for method in document["methods"] for row in method["outcome"]))
    handles = [Patch(facecolor=COLOURS[letter], label=SHORT[letter]) for letter in COLOURS if letter in used]
    figure.legend(handles=handles, loc=place, ncols=len(handles), fontsize=9,
                  bbox_to_anchor=(0.0, 0.0, 1.0, 1.0 - below / figure.get_figheight()))


def labels(axis):
    """Time steps as 1/60, the rest as a person writes it."""
    if axis["label"].startswith("time step"):
        return [f"1/{round(1.0 / value)}" for value in axis["values"]]
    return [value if isinstance(value, str) else plain(value) if value >= 1000 else f"{value:g}"
            for value in axis["values"]]


def title_of(method):
    if method["name"] == "none":
        return "No limiter"
    return TITLES.get(method["name"], method["title"])


def draw_map(document):
    methods = document["methods"]
    columns = min(len(methods), 5)
    rows = -(-len(methods) // columns)
    # Not so narrow that the legend is cut off.
    figure, axes = new_chart(columns, rows, width=max(1.2 + 2.0 * columns, 7.2), height=1.2 + 1.9 * rows, sharex=True,
                             sharey=True, squeeze=False)
    for place, axis in enumerate(axes.flat):
        if place >= len(methods):
            axis.set_visible(False)
            continue
        method = methods[place]
        squares(axis, method["outcome"])
        dots(axis, method["outcome"], method["not_ok"])
        weight = "bold" if method["name"].startswith("apsl") else "normal"
        axis.set_title(title_of(method), fontsize=8, fontweight=weight)
        axis.set_xticks(range(len(document["x"]["values"])), labels(document["x"]), rotation=90, fontsize=7)
        axis.set_yticks(range(len(document["y"]["values"])), labels(document["y"]), fontsize=7)
        axis.tick_params(labelbottom=place + columns >= len(methods))
    figure.suptitle(document["title"] + "\n\n", x=0.01, ha="left", fontsize=11)
    figure.supxlabel(document["x"]["label"], fontsize=9)
    figure.supylabel(document["y"]["label"], fontsize=9)
    legend(figure, document, "upper left", below=0.22)
    return figure


def draw_cases(document):
    """One column a method, one row a case, the greatest area change written in."""
    methods, cases = document["methods"], document["cases"]
    figure, axis = new_chart(width=11.0, height=2.2 + 0.27 * len(cases))
    table = ["".join(method["outcome"][row] for method in methods) for row in range(len(cases))]
    squares(axis, table)
    for row in range(len(cases)):
        for column, method in enumerate(methods):
            greatest = method["greatest"][row][0]
            text = "–" if greatest is None else plain(float(f"{100.0 * greatest:.2g}")) if greatest < 10.0 else "> 1000"
            axis.text(column, row, text + ("*" if method["not_ok"][row] else ""), ha="center", va="center", fontsize=6,
                      color="white" if table[row][column] in "gd" else "#222222")
    axis.set_xticks(range(len(methods)), [title_of(method) for method in methods], rotation=45, ha="left", fontsize=7.5)
    axis.xaxis.tick_top()
    axis.set_yticks(range(len(cases)), cases, fontsize=8)
    axis.invert_yaxis()
    share = 0.35 / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0.0, share, 1.0, 1.0 - share))  # room for the legend
    legend(figure, document, "lower center")
    return figure


def run(arguments):
    parser = OneLineParser(description=__doc__)
    parser.add_argument("results", help="docs/stability/MAP.json")
    parser.add_argument("--out", required=True, help="the picture, PNG")
    options = parser.parse_args(arguments)
    document = read_json(options.results)
    try:
        figure = draw_cases(document) if "cases" in document else draw_map(document)
    except (KeyError, TypeError, IndexError, ValueError) as error:
        raise ChartError(f"{options.results}: no map ({type(error).__name__}: {error})") from None
    save_chart(figure, options.out, 95)


if __name__ == "__main__":
    sys.exit(exit_code_of(run))
