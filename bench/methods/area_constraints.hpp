// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

namespace apsl::methods {

struct TriangleArea {
    float area;                                ///< m²
    std::array<Eigen::Vector3f, 3> gradients;  ///< m, ∂A/∂x_i = ½ n × e_i, e_i = x_k − x_j; zero where the area is
};

inline TriangleArea triangle_area(const Eigen::Vector3f& xi, const Eigen::Vector3f& xj, const Eigen::Vector3f& xk) {
    const Eigen::Vector3f ei = xk - xj;
    const Eigen::Vector3f ej = xi - xk;
    const Eigen::Vector3f doubled = ei.cross(ej);
    const float doubled_area = doubled.norm();
    if (!(doubled_area > 0.0f)) {
        const Eigen::Vector3f zero = Eigen::Vector3f::Zero();
        return {0.0f, {zero, zero, zero}};
    }
    const Eigen::Vector3f half_normal = 0.5f / doubled_area * doubled;
    const Eigen::Vector3f gi = half_normal.cross(ei);
    const Eigen::Vector3f gj = half_normal.cross(ej);
    return {0.5f * doubled_area, {gi, gj, -(gi + gj)}};
}

/// C = A − A⁰.
struct AreaConstraint {
    Triangle vertices;
    std::array<float, 3> inverse_masses;  ///< 1/kg
    float rest_area;                      ///< m²

    TriangleArea at(std::span<const Eigen::Vector3f> positions) const {
        return triangle_area(positions[vertices[0]], positions[vertices[1]], positions[vertices[2]]);
    }

    /// 1/kg · m², Σ w_i |∂A/∂x_i|².
    float weight(const TriangleArea& now) const {
        float sum = 0.0f;
        for (std::size_t k = 0; k < 3; ++k) sum += inverse_masses[k] * now.gradients[k].squaredNorm();
        return sum;
    }

    /// Δx_i = w_i `multiplier` (kg) ∂A/∂x_i.
    void move(const TriangleArea& now, float multiplier, std::span<Eigen::Vector3f> positions) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (inverse_masses[k] > 0.0f) positions[vertices[k]] += inverse_masses[k] * multiplier * now.gradients[k];
    }
};

/// One for each triangle of the mesh, in its order, but for those with three pinned vertices: nothing could move.
std::vector<AreaConstraint> area_constraints(const Cloth& cloth);

/// Position-based dynamics (Müller et al. 2007, Section 3.3): Δx_i = −w_i C / (Σ_j w_j |∇_j C|²) ∇_i C.
inline void project_area(const AreaConstraint& triangle, std::span<Eigen::Vector3f> positions) {
    const TriangleArea now = triangle.at(positions);
    const float weight = triangle.weight(now);
    if (weight > 0.0f) triangle.move(now, (triangle.rest_area - now.area) / weight, positions);
}

}  // namespace apsl::methods
