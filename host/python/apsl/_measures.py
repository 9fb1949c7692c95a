# SPDX-License-Identifier: MIT
from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import _core
from ._records import Device


def devices() -> list[Device]:
    """The OpenCL devices of all platforms; empty where there is none."""
    return [Device(**fields) for fields in _core.devices()]


def rest_areas(positions: npt.ArrayLike, triangles: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """m², [T]: the triangles' areas where the cloth is at rest. positions: m, [V, 3]. triangles: [T, 3]."""
    return _core.rest_areas(positions, triangles)


def rest_shapes(positions: npt.ArrayLike, triangles: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """1/m, [T, 4]: the triangles' shapes where the cloth is at rest, for a limiter with limits_stretch.

    The inverse M of the 2 × 2 matrix of a triangle's edges x₁ − x₀ and x₂ − x₀ in its plane, row by row. Zeros, which
    stand for no ceiling, where a triangle has no area. positions: m, [V, 3]. triangles: [T, 3].
    """
    return _core.rest_shapes(positions, triangles)


def rest_hinges(positions: npt.ArrayLike, triangles: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """[H, 2]: what the cloth's hinges are where it is at rest, for a limiter with bends.

    A hinge is an edge of two triangles; hinges are in ascending order of its vertices. The first number is the angle
    between the triangles, rad, the second l²/(A₀ + A₁) of edge and triangles; zeros, which let it bend freely, where a
    triangle has no area. positions: m, [V, 3]. triangles: [T, 3].
    """
    return _core.rest_hinges(positions, triangles)


def tethers_to_pins(rest_positions: npt.ArrayLike, triangles: npt.ArrayLike, pinned: npt.ArrayLike, per_vertex: int,
                    stretch: float = 1.0) -> tuple[npt.NDArray[np.uint32], npt.NDArray[np.float32]]:
    """Tethers for a limiter with tethers_per_vertex: anchors, vertices, and lengths, m, both [V, per_vertex].

    Each vertex that is not pinned has one to the nearest pinned vertex of each of the per_vertex nearest pinned pieces,
    as long as the way there over the surface at rest, times stretch. Length 0 is no tether. pinned: vertices, [P], in
    any order, such as np.flatnonzero(inverse_masses == 0). rest_positions: m, [V, 3], at rest. triangles: [T, 3].
    Raises Error for shapes and types that do not fit, positions that are not finite, pinned vertices that are not
    there, per_vertex 0, stretch not above 0.
    """
    return _core.tethers_to_pins(rest_positions, triangles, pinned, per_vertex, stretch)


def pinned_piece_count(triangles: npt.ArrayLike, vertex_count: int, pinned: npt.ArrayLike) -> int:
    """Sets of pinned vertices that edges connect: as many tethers a vertex wants, one to each.

    triangles: [T, 3]. pinned: vertices, [P], in any order. Raises Error as tethers_to_pins() does.
    """
    return _core.pinned_piece_count(triangles, vertex_count, pinned)


def area_change(positions: npt.ArrayLike, triangles: npt.ArrayLike,
                rest_areas: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """|A − A⁰| / A⁰ of each triangle, [T], 0 where A⁰ ≤ 0.

    positions: m, [V, 3]. triangles: [T, 3]. rest_areas: m², [T].
    """
    return _core.area_change(positions, triangles, rest_areas)
