// SPDX-License-Identifier: MIT
#pragma once

#include "stability/fuzz/random_numbers.hpp"
#include "support/meshes.hpp"

#include <cstdint>

namespace apsl::test {

/// One to some 300 triangles about a metre across: grids with holes, tubes, fans, fins on one edge, closed surfaces,
/// soups of any vertices, two such side by side, vertices in no triangle.
Mesh random_mesh(Random& random);

/// Triangles that share nothing.
Mesh loose_triangles(std::uint32_t count);

}  // namespace apsl::test
