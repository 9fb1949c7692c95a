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


def area_change(positions: npt.ArrayLike, triangles: npt.ArrayLike,
                rest_areas: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """|A − A⁰| / A⁰ of each triangle, [T], 0 where A⁰ ≤ 0.

    positions: m, [V, 3]. triangles: [T, 3]. rest_areas: m², [T].
    """
    return _core.area_change(positions, triangles, rest_areas)
