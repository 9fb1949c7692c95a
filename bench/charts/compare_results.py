# SPDX-License-Identifier: MIT
"""Results of `apsl compare`, read and sorted for charts."""

import math

from chart_tools import ChartError, OneLineParser, read_json, save_chart

WIDE_DOTS_PER_INCH = 120  # 11 inches make 1320 pixels
OURS = "apsl"  # names of our own variants begin so
# Of a run of more than ten frames, over those after the first ten: area change, stretch and edges above 1.
SETTLED_AREA, SETTLED_EXCESS, SETTLED_EDGE = "settled_area_change", "settled_stretch_excess", "settled_edge_excess"
WORST_SHOWN = 10.0  # 1000 %: a run beyond it has broken down, whatever its status says

# Baselines keep their colour and marker from chart to chart; twenty are told apart by both together.
BASELINE_COLOURS = ("#D55E00", "#009E73", "#CC79A7", "#E69F00", "#8c564b", "#6b6ecf", "#637939")
BASELINE_MARKERS = ("s", "^", "D", "v", "P", "X", "<", ">")
OUR_COLOURS = ("#0072B2", "#56B4E9", "#003f6b", "#4a90c2", "#7fb3d5", "#1f4e79", "#9ecae1")
OUR_MARKERS = ("o", "s", "D", "^", "v", "P", "X", "*")
# Apart from the other blues: small steps, and what the library does by default.
OWN_COLOURS = {"apsl_small_steps": "#1a1aff", "apsl_chebyshev": "#00a0ff", "apsl_defaults": "#000000",
               "apsl_ceiling": "#5b2be0", "apsl_tethers": "#0b8f8f"}


def results_parser(description, scene=False):
    """What every chart of results takes from the command line."""
    parser = OneLineParser(description=description)
    parser.add_argument("results", metavar="results.json")
    if scene:
        parser.add_argument("--scene", required=True, help="name in the results")
    parser.add_argument("--out", required=True, metavar="FILE.png")
    return parser


def read_results(path):
    results = read_json(path)
    try:
        for run in results["runs"]:
            str(run["scene"]), str(run["method"]), str(run["title"]), dict(run["parameters"]), str(run["status"])
            run["milliseconds"] = 1e3 * number(run["limiter_seconds_per_frame"]["median"])
            for field in ("max_area_change", "mean_max_area_change", "rms_area_change"):
                run[field] = number(run[field])
            if settled := run.get("settled"):
                run[SETTLED_AREA] = number(settled["max_area_change"])
                run[SETTLED_EXCESS] = number(settled["max_principal_stretch"]) - 1.0
                run[SETTLED_EDGE] = number(settled["max_edge_stretch"]) - 1.0
        {scene["name"]: scene["document"] for scene in results["scenes"]}
    except (KeyError, TypeError, ValueError) as error:
        raise ChartError(f"{path}: not results of apsl compare ({type(error).__name__}: {error})") from None
    return results


def number(value):
    return math.nan if value is None else float(value)


def is_ours(method):
    return method.startswith(OURS)


def held(run):
    """Whether the run went to its end and what it left can be drawn."""
    return (run["status"] not in ("diverged", "timed_out")
            and all(0.0 < run[field] <= WORST_SHOWN for field in ("max_area_change", "mean_max_area_change")))


def by_method(runs):
    """{method: its runs}, ours first, the others in the order in which they were run."""
    methods = {}
    for run in sorted(runs, key=lambda run: not is_ours(run["method"])):
        methods.setdefault(run["method"], []).append(run)
    return methods


def styles(results):
    """{method: (colour, marker, line width)}, the same for every chart of these results."""
    table = {}
    baselines = ours = 0
    for run in results["runs"]:
        method = run["method"]
        if method in table:
            continue
        if is_ours(method):
            colour = OWN_COLOURS.get(method, OUR_COLOURS[ours % len(OUR_COLOURS)])
            table[method] = (colour, OUR_MARKERS[ours % len(OUR_MARKERS)], 2.2)
            ours += 1
        else:
            table[method] = (BASELINE_COLOURS[baselines % len(BASELINE_COLOURS)],
                             BASELINE_MARKERS[(baselines + 3 * (baselines // len(BASELINE_COLOURS))) % len(BASELINE_MARKERS)], 1.1)
            baselines += 1
    return table


def front(runs, error):
    """Of runs, those that no other beats in both time and error; by time, rising."""
    best, least = [], math.inf
    for run in sorted(runs, key=lambda run: (run["milliseconds"], run[error])):
        if run[error] < least:
            best.append(run)
            least = run[error]
    return best


def time_at(runs, error, target):
    """Milliseconds at which the front of `runs` reaches `target`, between its points by the logarithms; None where it
    does not."""
    points = [(run["milliseconds"], run[error]) for run in front(runs, error) if run["milliseconds"] > 0.0]
    if not points or points[-1][1] > target:
        return None
    before = None
    for milliseconds, value in points:
        if value <= target:
            if before is None:
                return milliseconds
            share = math.log(before[1] / target) / math.log(before[1] / value)
            return before[0] * (milliseconds / before[0]) ** share
        before = (milliseconds, value)
    return None


def title_of(results, scene):
    triangles = next(run["triangles"] for run in results["runs"] if run["scene"] == scene)
    machine = results["machine"]
    return f"{scene}, {triangles:,} triangles, {machine['processor']}, {machine['cores']} cores"


def legend_below(figure, handles, columns=4):
    """A legend of {label: handle} under all axes, which make room for it; fewer columns where so many do not fit."""
    legend = figure.legend(handles.values(), handles.keys(), loc="lower center", ncol=columns, fontsize=8.5)
    while columns > 1 and legend.get_window_extent(figure.canvas.get_renderer()).width > figure.bbox.width:
        legend.remove()
        columns -= 1
        legend = figure.legend(handles.values(), handles.keys(), loc="lower center", ncol=columns, fontsize=8.5)
    rows = -(-len(handles) // columns)
    room = (0.22 * rows + 0.1) / figure.get_size_inches()[1]
    figure.get_layout_engine().set(rect=(0.0, room, 1.0, 1.0 - room))


def save_comparison(figure, axes, path, title=None):
    """Legend, title and file of a chart with a curve for each method."""
    legend_below(figure, labelled(axes))
    if title:
        figure.suptitle(title, x=0.01, ha="left", fontsize=10.5)
    save_chart(figure, path, WIDE_DOTS_PER_INCH)


def labelled(axes):
    """{label: handle} over several axes, each label once."""
    return {label: handle for axis in axes for handle, label in zip(*axis.get_legend_handles_labels())}
