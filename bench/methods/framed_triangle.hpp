// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace apsl::methods {

/// A triangle and its rest shape in its own plane. With edges p₁ = x_j − x_i, p₂ = x_k − x_i of the moved triangle
/// (i, j, k) the deformation gradient is F = [p₁ p₂] Q⁻¹, 3 × 2, where Q = [q₁ q₂] holds the rest edges.
struct FramedTriangle {
    std::array<std::uint32_t, 3> vertices;
    std::array<float, 3> inverse_masses;  ///< 1/kg
    /// m, Q. First axis: the x axis laid into the triangle's plane (z where x stands nearly upright on it), as the
    /// meshes here bring no texture coordinates that would tell warp from weft. Second axis: n × first.
    Eigen::Matrix2f edges;
    Eigen::Matrix2f inverse;  ///< 1/m, Q⁻¹
};

/// One for each triangle, in the mesh's order, but for those with three pinned corners, where nothing could move, and
/// those without area at rest, whose strain is not defined.
std::vector<FramedTriangle> framed_triangles(const Cloth& cloth);

}  // namespace apsl::methods
