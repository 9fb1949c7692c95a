#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws the frames that `apsl run --out DIR` wrote, coloured by area change or principal stretch: white at rest, red where stretched."""

import argparse
import re
import sys
from pathlib import Path

import numpy as np

from arguments import add_colour_and_camera, check_colour_and_camera
from cloth_sequence import choose_frames, read_cloth, read_colliders, read_index
from headless import ensure_display
from page import PAPER, USUAL_VIEWS, VIEWS, Image, Red, draw_row, panel_size, save_png
from picture_error import OneLineParser, PictureError, exit_code_of

CAMERA_SAMPLES = 24  # frames looked at to place the camera


def read_arguments(arguments):
    parser = OneLineParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("folder", metavar="DIR", help="what `apsl run --out DIR` wrote")
    parser.add_argument("--frames", default="all", help="all, last, or numbers and ranges: 0,30,60-90")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="each N-th of those frames only")
    parser.add_argument("--views", default=",".join(USUAL_VIEWS), help="panels, of " + ", ".join(VIEWS))
    parser.add_argument("--normalised", action="store_true", help="short for --views normalised")
    parser.add_argument("--size", default="1380x600", metavar="WxH", help="the picture, pixels")
    parser.add_argument("--out", metavar="DIR", help="folder for the pictures (default: DIR/pictures)")
    add_colour_and_camera(parser)
    options = parser.parse_args(arguments)
    options.views = ["normalised"] if options.normalised else options.views.split(",")
    match = re.fullmatch(r"(\d+)x(\d+)", options.size)
    if not match or not all(160 <= int(side) <= 8192 for side in match.groups()):
        raise PictureError(f"--size {options.size}: expected WxH, each from 160 to 8192 pixels, as in 1380x600")
    options.size = (int(match[1]), int(match[2]))
    if options.every < 1:
        raise PictureError(f"--every {options.every}: expected 1 or more")
    for view in options.views:
        if view not in VIEWS:
            raise PictureError(f"--views: unknown view '{view}'; expected some of {', '.join(VIEWS)}")
    check_colour_and_camera(options)
    return options


def motion(frames):
    """Vertex positions over the whole sequence, sampled: what the fixed camera has to hold."""
    places = sorted({round(place) for place in np.linspace(0, len(frames) - 1, CAMERA_SAMPLES)})
    clouds = []
    for place in places:
        points = read_cloth(frames[place]).points
        clouds.append(points[:: max(1, len(points) // 20000)])
    return np.concatenate(clouds)


def show_progress(done, total, last_path):
    if sys.stdout.isatty():
        filled = round(30 * done / total)
        print(f"\r[{'#' * filled}{'.' * (30 - filled)}] {done}/{total} frames", end="", flush=True)
    if done == total:
        end = "\n" if sys.stdout.isatty() else ""
        print(f"{end}{total} picture{'s' if total > 1 else ''}, the last one {last_path}")


def run(arguments):
    options = read_arguments(arguments)
    frames = read_index(options.folder)
    chosen = choose_frames(frames, options.frames, options.every)
    colliders = read_colliders(options.folder, options.scene)
    for frame in chosen:
        if not frame.path.is_file():
            raise PictureError(f"{frame.path}: no such file, though the index names it")
    ensure_display()

    from cloth_view import ClothView, fit_camera

    out = Path(options.out) if options.out else Path(options.folder) / "pictures"
    panel = panel_size(options.size, len(options.views))
    camera = fit_camera(motion(frames), panel[0] / panel[1], options.azimuth, options.elevation, options.zoom)
    window = ClothView(*panel, camera, colliders)
    digits = max(4, len(str(frames[-1].number)))
    for done, frame in enumerate(chosen, start=1):
        cloth = read_cloth(frame, with_stretch="stretch" in options.views)
        path = out / f"frame_{frame.number:0{digits}}.png"
        page = Image.new("RGB", options.size, PAPER)
        window.move_colliders(frame.time)
        draw_row(page, 0, page.height, window, cloth, options.views,
                 Red(options.red, options.red_stretch), f"frame {frame.number}")
        save_png(page, path)
        show_progress(done, len(chosen), path)


if __name__ == "__main__":
    sys.exit(exit_code_of(run))
