// SPDX-License-Identifier: MIT
#include "compare/measures.hpp"

#include "pipeline/geometry.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace apsl::compare {
namespace {

using scenes::vector_at;

Eigen::Matrix<double, 3, 2> edges(std::span<const double> positions, const Triangle& triangle) {
    Eigen::Matrix<double, 3, 2> columns;
    columns.col(0) = vector_at(positions, triangle[1]) - vector_at(positions, triangle[0]);
    columns.col(1) = vector_at(positions, triangle[2]) - vector_at(positions, triangle[0]);
    return columns;
}

}  // namespace

PrincipalStretch principal_stretch(const scenes::ClothState& cloth) {
    PrincipalStretch range{.min = std::numeric_limits<double>::infinity(), .max = 0.0};
    std::size_t a = 0;
    for (const Triangle& triangle : cloth.topology->triangles()) {
        if (!(cloth.rest_areas[a++] > 0.0)) continue;
        const Eigen::Matrix<double, 3, 2> rest = edges(cloth.rest_positions, triangle);
        const Eigen::Vector3d u = rest.col(0).normalized();
        const Eigen::Vector3d v = (rest.col(1) - rest.col(1).dot(u) * u).normalized();
        Eigen::Matrix2d in_plane;
        in_plane << rest.col(0).norm(), rest.col(1).dot(u), 0.0, rest.col(1).dot(v);
        const Eigen::Matrix<double, 3, 2> F = edges(cloth.positions, triangle) * in_plane.inverse();
        // Eigenvalues of FᵀF = [p q; q r]: the squares of the singular values.
        const double p = F.col(0).squaredNorm();
        const double q = F.col(0).dot(F.col(1));
        const double r = F.col(1).squaredNorm();
        const double middle = 0.5 * (p + r);
        const double half_width = std::hypot(0.5 * (p - r), q);
        range.max = std::max(range.max, std::sqrt(middle + half_width));
        range.min = std::min(range.min, std::sqrt(std::max(middle - half_width, 0.0)));
    }
    return range.max < range.min ? PrincipalStretch{} : range;
}

Deviation deviation(std::span<const double> positions, std::span<const double> expected) {
    Deviation result;
    double squares = 0.0;
    const std::size_t vertices = positions.size() / 3;
    for (std::size_t v = 0; v < vertices; ++v) {
        const double square = (vector_at(positions, v) - vector_at(expected, v)).squaredNorm();
        squares += square;
        result.max = std::max(result.max, std::sqrt(square));
    }
    result.rms = std::sqrt(squares / static_cast<double>(vertices));
    return result;
}

std::array<double, 3> mean_displacement(const scenes::ClothState& cloth) {
    std::array<double, 3> sum{};
    std::size_t count = 0;
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
        if (cloth.inverse_masses[v] == 0.0) continue;
        ++count;
        for (std::size_t k = 0; k < 3; ++k) sum[k] += cloth.positions[3 * v + k] - cloth.rest_positions[3 * v + k];
    }
    if (count > 0)
        for (double& component : sum) component /= static_cast<double>(count);
    return sum;
}

}  // namespace apsl::compare
