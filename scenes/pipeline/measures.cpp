// SPDX-License-Identifier: MIT
#include "pipeline/measures.hpp"

#include "pipeline/geometry.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace apsl::scenes {
namespace {

Eigen::Matrix<double, 3, 2> edges(std::span<const double> positions, const Triangle& triangle) {
    Eigen::Matrix<double, 3, 2> columns;
    columns.col(0) = vector_at(positions, triangle[1]) - vector_at(positions, triangle[0]);
    columns.col(1) = vector_at(positions, triangle[2]) - vector_at(positions, triangle[0]);
    return columns;
}

}  // namespace

std::vector<PrincipalStretch> principal_stretches(const ClothState& cloth) {
    std::vector<PrincipalStretch> stretches(cloth.rest_areas.size());
    for (std::size_t a = 0; a < stretches.size(); ++a) {
        if (!(cloth.rest_areas[a] > 0.0)) continue;
        const Triangle& triangle = cloth.topology->triangles()[a];
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
        stretches[a] = {.min = std::sqrt(std::max(middle - half_width, 0.0)), .max = std::sqrt(middle + half_width)};
    }
    return stretches;
}

PrincipalStretch range_of(const std::vector<PrincipalStretch>& stretches) {
    if (stretches.empty()) return {};
    PrincipalStretch range = stretches.front();
    for (const PrincipalStretch& stretch : stretches) {
        range.min = std::min(range.min, stretch.min);
        range.max = std::max(range.max, stretch.max);
    }
    return range;
}

EdgeStretch edge_stretch(const ClothState& cloth) {
    EdgeStretch stretch{.min = std::numeric_limits<double>::infinity(), .max = 0.0};
    for (const VertexPair edge : cloth.topology->edges()) {
        const double rest_length = edge_length(cloth.rest_positions, edge);
        if (rest_length > 0.0) {
            const double ratio = edge_length(cloth.positions, edge) / rest_length;
            stretch.min = std::min(stretch.min, ratio);
            stretch.max = std::max(stretch.max, ratio);
        }
    }
    return stretch.max < stretch.min ? EdgeStretch{} : stretch;
}

std::vector<double> area_changes(const ClothState& cloth) {
    return predicted_area_changes(cloth, 0.0);
}

std::vector<double> predicted_area_changes(const ClothState& cloth, double time_step) {
    const std::span<const double> positions = cloth.positions;
    const std::span<const double> velocities = cloth.velocities;
    std::vector<double> changes;
    changes.reserve(cloth.rest_areas.size());
    for (const Triangle& triangle : cloth.topology->triangles()) {
        const double rest_area = cloth.rest_areas[changes.size()];
        Eigen::Vector3d corner[3];
        for (int k = 0; k < 3; ++k)
            corner[k] = vector_at(positions, triangle[k]) + time_step * vector_at(velocities, triangle[k]);
        const double area = 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
        changes.push_back(rest_area > 0.0 ? std::abs(area - rest_area) / rest_area : 0.0);
    }
    return changes;
}

double pinned_area_change(const ClothState& cloth) {
    double greatest = 0.0;
    for (std::size_t t = 0; t < cloth.rest_areas.size(); ++t) {
        const Triangle& corners = cloth.topology->triangles()[t];
        const double rest_area = cloth.rest_areas[t];
        if (rest_area > 0.0 &&
            std::ranges::all_of(corners, [&](std::uint32_t v) { return cloth.inverse_masses[v] == 0.0; }))
            greatest = std::max(greatest, std::abs(triangle_area(cloth.positions, corners) - rest_area) / rest_area);
    }
    return greatest;
}

AreaChange summarize(const ClothState& cloth, const std::vector<double>& changes) {
    AreaChange summary;
    double weighted_squares = 0.0;
    double weights = 0.0;
    for (std::size_t triangle = 0; triangle < changes.size(); ++triangle) {
        if (cloth.rest_areas[triangle] > 0.0) {
            // Not std::max alone: a NaN must show and stay.
            if (changes[triangle] > summary.max || std::isnan(changes[triangle])) summary.max = changes[triangle];
            weighted_squares += cloth.rest_areas[triangle] * changes[triangle] * changes[triangle];
            weights += cloth.rest_areas[triangle];
        }
    }
    summary.rms = weights > 0.0 ? std::sqrt(weighted_squares / weights) : 0.0;
    return summary;
}

}  // namespace apsl::scenes
