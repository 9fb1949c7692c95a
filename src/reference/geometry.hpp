// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/topology.hpp>

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace apsl::reference {

template <class Real>
using Vector3 = Eigen::Matrix<Real, 3, 1>;

/// What one triangle a = (i, j, k) contributes to a sub-step.
template <class Real>
struct TriangleGeometry {
    Real area;             ///< m², A_a
    Vector3<Real> normal;  ///< unit normal n_a; zero where the area is zero
    /// m, corner gradients g_{a,i} = n_a × e_i, with e_i = x_k − x_j the edge opposite vertex i, and likewise for j, k.
    /// They point from that edge towards the vertex, |g_{a,i}| = |e_i|, and ∂A_a/∂x_i = ½ g_{a,i}.
    std::array<Vector3<Real>, 3> gradients;
};

/// Position of vertex v in [3V] numbers.
template <class Real>
Vector3<Real> position(std::span<const Real> positions, std::size_t v) {
    return Eigen::Map<const Vector3<Real>>(positions.data() + 3 * v);
}

/// Geometry of one triangle. A degenerate one (zero area, down to underflow) has a zero normal and zero gradients:
/// there ∂A/∂x has no direction. Numbers that are not finite stay so in the area.
template <class Real>
TriangleGeometry<Real> triangle_geometry(const Triangle& triangle, std::span<const Real> positions);

/// The same for every triangle, [T] into `geometry` (resized).
template <class Real>
void triangle_geometries(const Topology& topology, std::span<const Real> positions,
                         std::vector<TriangleGeometry<Real>>& geometry);

}  // namespace apsl::reference
