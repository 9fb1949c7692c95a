// SPDX-License-Identifier: MIT
#pragma once

#include "run/mesh.hpp"
#include "run/scene.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace apsl::scenes {

/// The vertices that a selection means on a mesh. Throws InputError beginning with `where`: a vertex out of range, a
/// corner that is none, a box without a vertex in it.
std::vector<std::uint32_t> select_vertices(const VertexSelection& selection, const Mesh& mesh,
                                           const std::string& where);

/// The vertices of each pin of the scene, as select_vertices.
std::vector<PinGroup> resolve_pins(const Scene& scene, const Mesh& mesh);

}  // namespace apsl::scenes
