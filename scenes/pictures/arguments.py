# SPDX-License-Identifier: MIT
"""The arguments that render.py and side_by_side.py share: the colouring and the one camera of a sequence."""

import math

from picture_error import PictureError


def add_colour_and_camera(parser):
    parser.add_argument("--red", type=float, default=0.10, help="area change |A − A⁰| / A⁰ that is pure red")
    parser.add_argument("--red-stretch", type=float, default=1.1, help="principal stretch that is pure red")
    parser.add_argument("--azimuth", type=float, default=35.0, help="camera, degrees from +z towards +x")
    parser.add_argument("--elevation", type=float, default=12.0, help="camera, degrees above the horizon")
    parser.add_argument("--zoom", type=float, default=1.0, help="above 1: closer than what holds the whole motion")
    parser.add_argument("--scene", metavar="FILE", help="scene to take colliders from (default: the report's)")


def check_colour_and_camera(options):
    if not 0.0 < options.red < math.inf:
        raise PictureError(f"--red {options.red}: expected an area change above 0, as in 0.10 for 10 %")
    if not 1.0 < options.red_stretch < math.inf:
        raise PictureError(f"--red-stretch {options.red_stretch}: expected a stretch above 1, as in 1.1")
    if not math.isfinite(options.azimuth):
        raise PictureError(f"--azimuth {options.azimuth}: expected degrees")
    if not -89.0 <= options.elevation <= 89.0:
        raise PictureError(f"--elevation {options.elevation}: expected -89 to 89 degrees")
    if not 0.0 < options.zoom < 1000.0:
        raise PictureError(f"--zoom {options.zoom}: expected above 0 and below 1000")
