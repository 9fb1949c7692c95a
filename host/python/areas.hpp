// SPDX-License-Identifier: MIT
#pragma once

#include "arrays.hpp"

namespace apsl::python {

/// m², [T]: the triangles' areas at `positions` (m, [V, 3]), in 64 bits.
Array<double> areas(pybind11::handle positions, pybind11::handle triangles);

/// 1/m, [T, 4]: Buffers::rest_shapes of a cloth that is at rest at `positions` (m, [V, 3]), in 64 bits.
Array<double> rest_shapes(pybind11::handle positions, pybind11::handle triangles);

/// rad and m²/m², [H, 2]: Buffers::rest_hinges of a cloth that is at rest at `positions` (m, [V, 3]), in 64 bits.
Array<double> rest_hinges(pybind11::handle positions, pybind11::handle triangles);

/// |A − A⁰| / A⁰, [T]; 0 where A⁰ ≤ 0, which the filter leaves alone.
Array<double> area_change(pybind11::handle positions, pybind11::handle triangles, pybind11::handle rest_areas);

}  // namespace apsl::python
