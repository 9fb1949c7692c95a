#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws a trace of scenes/embedded (Chrome's format): when the host queued each frame, and when the device was at it."""

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
    """The frames of the stages that the host had still to queue when the stage before had ended."""
    return [following[1] for done, following, queued in zip(device, device[1:], host[1:]) if queued[3] > done[3]]


def draw(host, device, path):
    figure, axes = plt.subplots(figsize=(9.0, 2.0), layout="constrained")
    for height, row in ((1, host), (0, device)):
        for _, frame, begin, end in row:
            axes.broken_barh([(begin, end - begin)], (height - 0.38, 0.76), facecolors=("#333333", "#999999")[frame % 2],
                             linewidth=0)
    axes.set_yticks([1, 0], ["host: enqueue", "device: queue"])
    waits = waits_for_host(host, device)
    where = f", the last in frame {waits[-1]}" if waits else ""
    axes.set_title(f"{device[-1][1] + 1} frames in two shades; the device had to wait for the host before {len(waits)} of "
                   f"{len(device) - 1} stages{where}", fontsize=9, loc="left")
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
    parser.add_argument("--out", required=True, metavar="FILE.png")
    options = parser.parse_args(arguments)
    draw(*read_rows(options.trace), options.out)


if __name__ == "__main__":
    sys.exit(exit_code_of(run))
