// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace apsl::methods {

/// C = |x_b − x_a| − L.
struct EdgeConstraint {
    std::array<std::uint32_t, 2> vertices;
    std::array<float, 2> inverse_masses;  ///< 1/kg
    float rest_length;                    ///< m, L

    /// Moves the ends by ±w `impulse` (kg·m): the ends approach each other where it points along x_b − x_a.
    void pull(const Eigen::Vector3f& impulse, std::span<Eigen::Vector3f> positions) const {
        if (inverse_masses[0] > 0.0f) positions[vertices[0]] += inverse_masses[0] * impulse;
        if (inverse_masses[1] > 0.0f) positions[vertices[1]] -= inverse_masses[1] * impulse;
    }
};

/// One for each pair of vertices, in their order, but for those with both pinned: nothing could move.
std::vector<EdgeConstraint> distance_constraints(const Cloth& cloth, std::span<const VertexPair> pairs);
/// One for each edge of the mesh, in its order, but for those with two pinned ends: nothing could move.
std::vector<EdgeConstraint> edge_constraints(const Cloth& cloth);

}  // namespace apsl::methods
