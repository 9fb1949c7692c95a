#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws a trace of scenes/embedded (Chrome's format): the whole run, and one frame of the device's queue."""

import argparse
import json
import sys
from pathlib import Path

from picture_error import OneLineParser, PictureError, exit_code_of, needs_package

try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
except ImportError as missing:
    needs_package("python3-matplotlib", missing)

HOST, DEVICE = 1, 2  # thread numbers of the two rows
# Okabe and Ito's colours, told apart by colour-blind eyes as well.
COLOURS = ("#E69F00", "#56B4E9", "#0072B2", "#009E73", "#CC79A7", "#D55E00")


def read_rows(path):
    """The slices of the host's row and of the device's, the same stages in the same order; times in ms."""
    try:
        events = json.loads(Path(path).read_text())["traceEvents"]
        slices = [(event["tid"], event["name"], event["args"]["frame"], 1e-3 * event["ts"],
                   1e-3 * (event["ts"] + event["dur"])) for event in events if event["ph"] == "X"]
    except OSError as error:
        raise PictureError(f"{path}: cannot be read ({error.strerror})") from None
    except (ValueError, KeyError, TypeError) as error:
        raise PictureError(f"{path}: not a trace of traced_cloth ({error!r})") from None
    host, device = ([s[1:] for s in slices if s[0] == row] for row in (HOST, DEVICE))
    if not device or [s[:2] for s in host] != [s[:2] for s in device]:
        raise PictureError(f"{path}: expected the same stages on the host's row and on the device's, at least one")
    return host, device


def waits_for_host(host, device):
    """The pairs of stages that follow one another within a frame, and the frames of those of them in which the host had
    still to queue the second one when the first one ended."""
    pairs = [(done, queued) for done, following, queued in zip(device, device[1:], host[1:]) if done[1] == following[1]]
    return len(pairs), [done[1] for done, queued in pairs if queued[3] > done[3]]


def draw_row(axes, height, slices, colour):
    for name, frame, begin, end in slices:
        axes.broken_barh([(begin, end - begin)], (height - 0.38, 0.76), facecolors=colour(name, frame), linewidth=0)


def draw(host, device, frame, path):
    of_frame = [s for s in device if s[1] == frame]
    if not of_frame:
        raise PictureError(f"--frame {frame}: the trace holds frames 0 to {device[-1][1]}")
    names = list(dict.fromkeys(s[0] for s in device))
    colour_of = {name: COLOURS[n % len(COLOURS)] for n, name in enumerate(names)}
    figure, (whole, one) = plt.subplots(2, 1, figsize=(9.0, 4.2), layout="constrained")

    for height, row in ((1, host), (0, device)):
        draw_row(whole, height, row, lambda name, number: ("#333333", "#999999")[number % 2])
    whole.set_yticks([1, 0], ["host: enqueue", "device: queue"])
    pairs, waits = waits_for_host(host, device)
    where = f", the last in frame {waits[-1]}" if waits else ""
    whole.set_title(f"{device[-1][1] + 1} frames in two shades; within a frame the device had to wait for the host before "
                    f"{len(waits)} of {pairs} stages{where}", fontsize=9, loc="left")

    first, last = of_frame[0][2], of_frame[-1][3]
    draw_row(one, 0, [(name, number, begin - first, end - first) for name, number, begin, end in of_frame],
             lambda name, number: colour_of[name])
    one.set_yticks([0], ["device: queue"])
    busy = sum(end - begin for _, _, begin, end in of_frame) / (last - first)
    one.set_title(f"frame {frame}: the device is in a stage {100.0 * busy:.1f} % of the time", fontsize=9, loc="left")
    for name in names:
        one.broken_barh([], (0, 0), facecolors=colour_of[name], label=name)
    one.legend(ncols=len(names), loc="upper center", bbox_to_anchor=(0.5, -0.35), fontsize=8, frameon=False)
    for axes in (whole, one):
        axes.set_xlabel("ms", fontsize=8)
        axes.tick_params(labelsize=8)
        axes.margins(x=0.01)
        for side in ("top", "right", "left"):
            axes.spines[side].set_visible(False)
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=120)
    plt.close(figure)


def run(arguments):
    parser = OneLineParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("trace", metavar="TRACE", help="what `traced_cloth --trace` wrote")
    parser.add_argument("--frame", type=int, default=8, help="the frame to draw alone")
    parser.add_argument("--out", required=True, metavar="FILE.png")
    options = parser.parse_args(arguments)
    draw(*read_rows(options.trace), options.frame, options.out)


if __name__ == "__main__":
    sys.exit(exit_code_of(run))
