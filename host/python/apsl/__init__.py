# SPDX-License-Identifier: MIT
"""Keeps simulated cloth from over-stretching by preserving triangle areas (Han 2015), on OpenCL.

    limiter = apsl.StrainLimiter(triangles, vertex_count)
    velocities, stats = limiter.limit(positions, velocities, inverse_masses, rest_areas, time_step=1 / 60)

Units are SI. V is the number of vertices, T of triangles. Arrays may be anything numpy takes for real numbers
(triangles: integers); float32 without gaps is passed as it is, all else converted. What is wrong raises apsl.Error.

Arrays that live on the device already stay there, with pyopencl or without:

    limiter = apsl.StrainLimiter(triangles, vertex_count, context=context)
    event = limiter.enqueue(queue, positions, velocities, inverse_masses, rest_areas, time_step=1 / 60)
"""

from ._core import __version__
from ._limiter import StrainLimiter
from ._measures import (area_change, devices, pinned_piece_count, rest_areas, rest_hinges, rest_shapes,
                        tethers_to_pins)
from ._records import Device, DeviceOptions, Error, Options, Parameters, Stats

__all__ = ["Device", "DeviceOptions", "Error", "Options", "Parameters", "Stats", "StrainLimiter", "__version__",
           "area_change", "devices", "pinned_piece_count", "rest_areas", "rest_hinges", "rest_shapes",
           "tethers_to_pins"]
