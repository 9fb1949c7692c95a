#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""One frame of the same cloth with the filter off and on, in both colourings, in one PNG file."""

import argparse
import sys
from pathlib import Path

import numpy as np

from arguments import add_colour_and_camera, check_colour_and_camera
from cloth_sequence import choose_frames, read_cloth, read_colliders, read_index
from headless import ensure_display
from page import PAPER, USUAL_VIEWS, Image, Red, draw_row, panel_size, save_png
from picture_error import OneLineParser, PictureError, exit_code_of


def read_arguments(arguments):
    parser = OneLineParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("off", metavar="OFF_DIR", help="`apsl run --out` of the scene without strain limiting")
    parser.add_argument("on", metavar="ON_DIR", help="`apsl run --out` of the scene with it")
    parser.add_argument("--frame", required=True, help="frame number, or last")
    parser.add_argument("--out", required=True, metavar="FILE.png")
    parser.add_argument("--titles", nargs=2, default=["filter off", "filter on"], metavar=("OFF", "ON"))
    parser.add_argument("--width", type=int, default=1200, help="pixels")
    parser.add_argument("--max-bytes", type=int, default=300_000, help="above it, colours become a palette")
    add_colour_and_camera(parser)
    options = parser.parse_args(arguments)
    if options.frame != "last" and not options.frame.isdigit():
        raise PictureError(f"--frame {options.frame}: expected a frame number, or last")
    if not 480 <= options.width <= 8192:
        raise PictureError(f"--width {options.width}: expected 480 to 8192 pixels")
    if Path(options.out).suffix.lower() != ".png":
        raise PictureError(f"--out {options.out}: expected a name that ends in .png")
    check_colour_and_camera(options)
    return options


def run(arguments):
    options = read_arguments(arguments)
    folders = (options.off, options.on)
    cloths, frames = [], []
    for folder in folders:
        frames += choose_frames(read_index(folder), options.frame)
        cloths.append(read_cloth(frames[-1]))
    colliders = read_colliders(options.on, options.scene)
    ensure_display()

    from cloth_view import ClothView, fit_camera

    row = (options.width, round(0.38 * options.width))
    panel = panel_size(row, len(USUAL_VIEWS))
    # One camera for both, or the stretched cloth would be shrunk to the size of the other.
    everything = np.concatenate([cloth.points for cloth in cloths])
    camera = fit_camera(everything, panel[0] / panel[1], options.azimuth, options.elevation, options.zoom)
    window = ClothView(*panel, camera, colliders)
    page = Image.new("RGB", (row[0], 2 * row[1]), PAPER)
    for place, (cloth, frame, title) in enumerate(zip(cloths, frames, options.titles)):
        window.move_colliders(frame.time)
        draw_row(page, place * row[1], row[1], window, cloth, USUAL_VIEWS,
                 Red(options.red, options.red_stretch), f"{title}, frame {frame.number}")
    save_png(page, options.out, options.max_bytes)
    print(f"{options.out}: {Path(options.out).stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    sys.exit(exit_code_of(run))
