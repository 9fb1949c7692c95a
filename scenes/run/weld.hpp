// SPDX-License-Identifier: MIT
#pragma once

#include "run/polygon_mesh.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace apsl::scenes {

/// For every vertex the first one that lies within `distance` of it (m, > 0) and was not itself taken to another; its
/// own number where there is none. `positions`: m, [3V].
std::vector<std::uint32_t> first_within(std::span<const double> positions, double distance);

/// Merges the vertices of a mesh that lie within `distance` (m, > 0) into the first of them, which stays where it is.
/// Returns the new number of each old one.
std::vector<std::uint32_t> weld(PolygonMesh& mesh, double distance);

}  // namespace apsl::scenes
