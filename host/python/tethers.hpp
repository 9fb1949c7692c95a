// SPDX-License-Identifier: MIT
#pragma once

#include "arrays.hpp"

namespace apsl::python {

/// Buffers::tether_anchors and tether_lengths of one cloth, [V, per_vertex] each, as apsl::tethers_to_pins has them.
/// rest_positions: m, [V, 3]. pinned: [P] of vertices.
pybind11::tuple tethers_to_pins(pybind11::handle rest_positions, pybind11::handle triangles, pybind11::handle pinned,
                                pybind11::handle per_vertex, pybind11::handle stretch);

/// As apsl::pinned_piece_count has it.
std::size_t pinned_piece_count(pybind11::handle triangles, pybind11::handle vertex_count, pybind11::handle pinned);

}  // namespace apsl::python
