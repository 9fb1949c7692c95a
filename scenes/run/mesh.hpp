// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/topology.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace apsl::scenes {

/// Triangles and where their vertices lie at rest, in the order they were made or read in.
struct Mesh {
    std::vector<double> positions;    ///< m, [3V]
    std::vector<Triangle> triangles;  ///< [T], counter-clockwise
    std::vector<std::uint32_t>
        welded_to;                      ///< the vertex that each vertex of a file became; empty where none was welded
    std::vector<std::string> warnings;  ///< of the file, one line each, with what to do

    std::size_t vertex_count() const { return positions.size() / 3; }
};

}  // namespace apsl::scenes
