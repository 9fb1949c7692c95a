# SPDX-License-Identifier: MIT
"""What every chart here shares: colours, size, reading JSON, writing the PNG file whole, errors in one line."""

import argparse
import contextlib
import io
import json
import os
import sys
from pathlib import Path

try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
except ImportError as missing:
    print(f"error: {missing}: apt-get install python3-matplotlib", file=sys.stderr)
    sys.exit(2)

# Okabe and Ito's colours, told apart by colour-blind eyes as well; markers say the same a second time.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#444444")
MARKERS = ("o", "s", "^", "D", "v", "P", "X")
INK, FAINT = "#222222", "#8a8a8a"
DOTS_PER_INCH = 150  # 8 inches make 1200 pixels, a README's width on a dense screen


class ChartError(Exception):
    """Something the user can put right; the message is one line."""


class OneLineParser(argparse.ArgumentParser):
    def __init__(self, **options):
        super().__init__(formatter_class=argparse.ArgumentDefaultsHelpFormatter, **options)

    def error(self, message):
        raise ChartError(f"{message} (see --help)")


def exit_code_of(run):
    """Runs `run(arguments)` on the command line; the exit code, any ChartError told in one line."""
    try:
        run(sys.argv[1:])
    except ChartError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    return 0


def read_json(path):
    try:
        return json.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise ChartError(f"{path}: cannot be read ({error.strerror})") from None
    except ValueError as error:
        raise ChartError(f"{path}: not JSON ({error})") from None


def write_whole(path, data):
    """Writes bytes whole or not at all."""
    path = Path(path)
    part = path.with_name(path.name + ".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        part.write_bytes(data)
        os.replace(part, path)
    except OSError as error:
        with contextlib.suppress(OSError):
            part.unlink()
        raise ChartError(f"{path}: cannot be written ({error.strerror})") from None


def new_chart(columns=1, rows=1, width=8.0, height=4.2, **options):
    plt.rcParams.update({
        "font.size": 10, "axes.edgecolor": FAINT, "axes.labelcolor": INK, "text.color": INK,
        "xtick.color": INK, "ytick.color": INK, "axes.spines.top": False, "axes.spines.right": False,
        "axes.grid": True, "grid.color": "#e4e4e4", "grid.linewidth": 0.8, "axes.axisbelow": True,
        "lines.linewidth": 1.8, "legend.frameon": False, "axes.titlesize": 10.5, "axes.titlelocation": "left",
    })
    return plt.subplots(rows, columns, figsize=(width, height), constrained_layout=True, **options)


def save_chart(figure, path, dots_per_inch=DOTS_PER_INCH):
    if Path(path).suffix.lower() != ".png":
        raise ChartError(f"--out {path}: expected a name that ends in .png")
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=dots_per_inch, facecolor="white")
    plt.close(figure)
    write_whole(path, file.getvalue())
    print(path)


def plain(value):
    """A number as a person writes it: 0.05, 3, 12 000, with no power of ten down to 1e-4."""
    if value == 0.0:
        return "0"
    if abs(value) >= 1000.0:
        return f"{value:,.0f}".replace(",", "\N{NO-BREAK SPACE}")
    return f"{value:.3g}" if abs(value) >= 1e-4 else f"{value:.0e}"


def percent(fraction):
    return f"{plain(100.0 * fraction)} %"


def log_axis(axis, unit=""):
    """Numbers written out on a logarithmic axis, small ones between the decades where there is room."""
    axis.set_major_locator(LogLocator(10.0))
    axis.set_major_formatter(FuncFormatter(lambda value, _: plain(value) + unit))
    axis.set_minor_formatter(NullFormatter())


def show_few_decades(axis, low, high, unit=""):
    """As log_axis, with 2 and 5 labelled as well where the axis spans less than two decades."""
    log_axis(axis, unit)
    if high / low < 150.0:
        axis.set_major_locator(LogLocator(10.0, subs=(1.0, 2.0, 5.0)))
