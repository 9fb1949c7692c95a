// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/topology.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace apsl::bench {

/// A cloth in need of filtering: every triangle stretched or compressed by a few percent, hung by two vertices.
struct Cloth {
    std::shared_ptr<const Topology> topology;
    std::vector<float> positions;       ///< m, [3V]
    std::vector<float> inverse_masses;  ///< 1/kg, [V]
    std::vector<float> rest_areas;      ///< m², [T]

    std::size_t triangle_count() const { return topology->triangle_count(); }
    std::size_t vertex_count() const { return topology->vertex_count(); }
};

/// A mesh to measure on: a grid of columns × rows vertices with alternating diagonals, or an OBJ file.
struct Mesh {
    std::uint32_t columns = 0, rows = 0;
    std::string file;  ///< taken where not empty

    /// Of the grid; 0 for a file, whose size shows when it is read.
    std::size_t triangle_count() const { return file.empty() ? std::size_t{2} * (columns - 1) * (rows - 1) : 0; }
};

/// The mesh, 1 m large, as it lies when the filter is called: stretched and compressed by up to 3 %, waved, each vertex
/// off by a little.
/// Throws std::runtime_error where the file cannot be read.
Cloth make_cloth(const Mesh& mesh);

}  // namespace apsl::bench
