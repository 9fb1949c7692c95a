// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/topology.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

namespace apsl::scenes {

// Three doubles in a row, seen as a vector.
inline Eigen::Map<const Eigen::Vector3d> vector_at(std::span<const double> values, std::size_t vertex) {
    return Eigen::Map<const Eigen::Vector3d>(values.data() + 3 * vertex);
}

inline Eigen::Map<Eigen::Vector3d> vector_at(std::span<double> values, std::size_t vertex) {
    return Eigen::Map<Eigen::Vector3d>(values.data() + 3 * vertex);
}

/// m from positions in m, [3V].
inline double edge_length(std::span<const double> positions, VertexPair edge) {
    return (vector_at(positions, edge[1]) - vector_at(positions, edge[0])).norm();
}

/// m, shortest first, from positions in m, [3V].
inline std::array<double, 3> sorted_edge_lengths(std::span<const double> positions, const Triangle& triangle) {
    std::array<double, 3> lengths{};
    for (std::size_t k = 0; k < 3; ++k) lengths[k] = edge_length(positions, {triangle[k], triangle[(k + 1) % 3]});
    std::sort(lengths.begin(), lengths.end());
    return lengths;
}

/// m, the diagonal of the box around positions in m, [3V ≥ 3].
inline double extent(std::span<const double> positions) {
    Eigen::Vector3d low = vector_at(positions, 0);
    Eigen::Vector3d high = low;
    for (std::size_t v = 0; v < positions.size() / 3; ++v) {
        low = low.cwiseMin(vector_at(positions, v));
        high = high.cwiseMax(vector_at(positions, v));
    }
    return (high - low).stableNorm();
}

/// m² from positions in m, [3V].
inline double triangle_area(std::span<const double> positions, const Triangle& triangle) {
    const Eigen::Vector3d a = vector_at(positions, triangle[0]);
    const Eigen::Vector3d b = vector_at(positions, triangle[1]);
    const Eigen::Vector3d c = vector_at(positions, triangle[2]);
    return 0.5 * (b - a).cross(c - a).norm();
}

}  // namespace apsl::scenes
