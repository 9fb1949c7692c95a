// SPDX-License-Identifier: MIT
#include "methods/framed_triangle.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cmath>
#include <optional>

namespace apsl::methods {
namespace {

std::optional<Eigen::Matrix2d> rest_edges(const Eigen::Vector3d& i, const Eigen::Vector3d& j,
                                          const Eigen::Vector3d& k) {
    const Eigen::Vector3d first_edge = j - i;
    const Eigen::Vector3d second_edge = k - i;
    const Eigen::Vector3d doubled = first_edge.cross(second_edge);
    const double doubled_area = doubled.norm();
    // Thinner than this, 32-bit edges say nothing about strain.
    if (!(doubled_area > 1e-6 * (first_edge.squaredNorm() + second_edge.squaredNorm()))) return std::nullopt;
    const Eigen::Vector3d normal = doubled / doubled_area;
    const Eigen::Vector3d warp = std::abs(normal.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d first = (warp - warp.dot(normal) * normal).normalized();
    const Eigen::Vector3d second = normal.cross(first);
    Eigen::Matrix2d edges;
    edges << first.dot(first_edge), first.dot(second_edge), second.dot(first_edge), second.dot(second_edge);
    return edges;
}

}  // namespace

std::vector<FramedTriangle> framed_triangles(const Cloth& cloth) {
    std::vector<FramedTriangle> triangles;
    triangles.reserve(cloth.topology->triangle_count());
    for (const Triangle& vertices : cloth.topology->triangles()) {
        const auto& [i, j, k] = vertices;
        const std::optional<Eigen::Matrix2d> edges =
            rest_edges(cloth.rest_positions[i], cloth.rest_positions[j], cloth.rest_positions[k]);
        const std::array<float, 3> inverse_masses{static_cast<float>(cloth.inverse_masses[i]),
                                                  static_cast<float>(cloth.inverse_masses[j]),
                                                  static_cast<float>(cloth.inverse_masses[k])};
        if (!edges || inverse_masses == std::array<float, 3>{}) continue;
        triangles.push_back({vertices, inverse_masses, edges->cast<float>(), edges->inverse().cast<float>()});
    }
    return triangles;
}

}  // namespace apsl::methods
