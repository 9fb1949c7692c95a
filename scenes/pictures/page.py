# SPDX-License-Identifier: MIT
"""Sets drawn panels on a page: titles, colour bars with their numbers, and the PNG file."""

import contextlib
import io
import os
from pathlib import Path
from typing import NamedTuple

from picture_error import PictureError, needs_package

try:
    from PIL import Image, ImageDraw, ImageFont
except ImportError as missing:
    needs_package("python3-pil", missing)

from cloth_view import BACKGROUND, Colouring

PAPER = tuple(round(255 * channel) for channel in BACKGROUND)
INK = (236, 239, 242)
FAINT = (168, 178, 190)
VIEWS = ("cloth", "absolute", "normalised", "stretch")
USUAL_VIEWS = VIEWS[:3]


def percent(fraction):
    """Three significant digits, as in "1.94 %"; "not finite" where the simulation broke down."""
    value = 100.0 * fraction
    if value != value or abs(value) == float("inf"):
        return "not finite"
    if abs(value) >= 1000.0:
        return f"{value:,.0f} %".replace(",", "\N{NO-BREAK SPACE}")
    if 0.0 < abs(value) < 1e-3:
        return "below 0.001 %"
    return f"{value:.3g} %"


def font(size, bold=False):
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    try:
        return ImageFont.truetype(name, size)
    except OSError:
        raise PictureError(f"the font {name} is missing: apt-get install fonts-dejavu-core") from None


class Red(NamedTuple):
    """What is drawn pure red, and from there on."""
    area_change: float
    stretch: float


def colouring(view, red, max_area_change):
    """What a view is coloured by; None for plain material."""
    if view == "cloth":
        return None
    if view == "stretch":
        return Colouring("principal_stretch", 1.0, red.stretch)
    if view == "absolute":
        return Colouring("area_change", 0.0, red.area_change)
    # A cloth at rest has nothing to normalise by and stays white; one that broke down falls back to the stated change.
    return Colouring("area_change", 0.0, max_area_change if 0.0 < max_area_change < float("inf") else red.area_change)


def caption(view, red, max_area_change):
    if view == "cloth":
        return "cloth"
    if view == "stretch":
        return f"principal stretch, red from {red.stretch:.3g}"
    if view == "absolute":
        return f"area change, red from {percent(red.area_change)}"
    return f"area change, red at the greatest ({percent(max_area_change)})"


def colour_bar(draw, left, top, width, height, colours, open_ended):
    """White to red over the range of `colours` with three ticks; `open_ended`: red holds for all above as well."""
    for column in range(width):
        rest = round(255 * (1 - column / max(width - 1, 1)))
        draw.line([(left + column, top), (left + column, top + height - 1)], fill=(255, rest, rest))
    label = font(max(11, round(1.05 * height)))
    for tick in range(3):
        at = left + round(tick * (width - 1) / 2)
        draw.line([(at, top + height), (at, top + height + 3)], fill=FAINT)
        value = colours.white + tick * (colours.red - colours.white) / 2
        text = percent(value) if colours.array == "area_change" else f"{value:.4g}"
        if tick == 2 and open_ended:
            text = "≥ " + text
        draw.text((at, top + height + 5), text, font=label, fill=FAINT, anchor="mt" if tick == 1 else
                  ("lt" if tick == 0 else "rt"))


def line_height(height):
    """The height of a line of text, pixels, for a row of panels that is `height` pixels tall, text included."""
    return max(12, round(height / 27))


def panel_size(size, views):
    """What is left for one panel of a row of size (width, height), pixels."""
    return size[0] // views, size[1] - round(5.4 * line_height(size[1]))


def draw_row(page, top, height, window, cloth, views, red, title):
    """A line of text, the panels, and under each its caption and colour bar, over the page's full width.

    title: what stands above the panels, on the left; the frame's greatest area change stands on the right.
    """
    draw = ImageDraw.Draw(page)
    unit = line_height(height)
    width, panel_height = panel_size((page.width, height), len(views))
    draw.text((unit, top + unit // 2), title, font=font(unit, bold=True), fill=INK)
    draw.text((page.width - unit, top + unit // 2), f"greatest area change {percent(cloth.max_area_change)}",
              font=font(unit), fill=INK, anchor="ra")
    for place, view in enumerate(views):
        left, below = place * width, top + 2 * unit + panel_height
        middle = left + width // 2
        colours = colouring(view, red, cloth.max_area_change)
        page.paste(window.draw(cloth.surface, colours), (left, top + 2 * unit))
        draw.text((middle, below + unit // 4), caption(view, red, cloth.max_area_change),
                  font=font(max(11, round(0.72 * unit))), fill=INK, anchor="ma")
        if colours is not None:
            bar = round(0.62 * width)
            colour_bar(draw, middle - bar // 2, below + round(1.5 * unit), bar, max(8, round(0.6 * unit)), colours,
                       open_ended=view != "normalised")


def png_bytes(image, limit=None):
    """limit: bytes; above it the colours are reduced to a palette, and to a smaller one."""
    for colours in (None, 256, 128, 64):
        file = io.BytesIO()
        reduced = image if colours is None else image.quantize(colours, method=Image.Quantize.MEDIANCUT)
        reduced.save(file, format="PNG", optimize=True)
        if limit is None or file.tell() <= limit:
            break
    return file.getvalue()


def save_png(image, path, limit=None):
    """Writes whole or not at all."""
    path = Path(path)
    part = path.with_name(path.name + ".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        part.write_bytes(png_bytes(image, limit))
        os.replace(part, path)
    except OSError as error:
        with contextlib.suppress(OSError):
            part.unlink()
        raise PictureError(f"{path}: cannot be written ({error.strerror or error})") from None
