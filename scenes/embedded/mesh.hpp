// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/topology.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

struct SquareMesh {
    std::vector<float> positions;  ///< m, three for each vertex
    std::shared_ptr<const apsl::Topology> topology;
};

/// A flat square sheet of side × side vertices, `width` m wide, its diagonals alternating.
inline SquareMesh square(std::uint32_t side, float width) {
    const float cell = width / static_cast<float>(side - 1);
    std::vector<float> positions;
    std::vector<apsl::Triangle> triangles;
    for (std::uint32_t v = 0; v < side * side; ++v) {
        const std::uint32_t row = v / side, column = v % side, below = v + side;
        positions.push_back(cell * static_cast<float>(column) - 0.5f * width);
        positions.push_back(0.0f);
        positions.push_back(cell * static_cast<float>(row) - 0.5f * width);
        if (row + 1 == side || column + 1 == side) continue;
        const bool even = (row + column) % 2 == 0;
        triangles.push_back({v, below, even ? v + 1 : below + 1});
        triangles.push_back({even ? below : v, below + 1, v + 1});
    }
    return {positions, apsl::Topology::build(triangles, positions.size() / 3)};
}

/// From vertex a to vertex b, m; positions: m, three for each vertex.
inline std::array<float, 3> edge(const std::vector<float>& positions, std::uint32_t a, std::uint32_t b) {
    const float *const x = &positions[3 * a], *const y = &positions[3 * b];
    return {y[0] - x[0], y[1] - x[1], y[2] - x[2]};
}

/// m²
inline float area(const std::vector<float>& positions, const apsl::Triangle& triangle) {
    const auto u = edge(positions, triangle[0], triangle[1]), v = edge(positions, triangle[0], triangle[2]);
    return 0.5f * std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
}
