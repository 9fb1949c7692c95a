// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/topology.hpp>

#include <cstddef>
#include <vector>

namespace apsl::scenes {

/// Triangles and where their vertices lie at rest, in the order they were made or read in.
struct Mesh {
    std::vector<double> positions;    ///< m, [3V]
    std::vector<Triangle> triangles;  ///< [T], counter-clockwise

    std::size_t vertex_count() const { return positions.size() / 3; }
};

}  // namespace apsl::scenes
