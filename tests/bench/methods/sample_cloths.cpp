// SPDX-License-Identifier: MIT
#include "bench/methods/sample_cloths.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>

namespace apsl::test {

using methods::Cloth;
using Positions = std::vector<Eigen::Vector3f>;

Cloth cloth_of(const Mesh& mesh, std::initializer_list<std::uint32_t> pinned) {
    Cloth cloth;
    cloth.topology = Topology::build(mesh.triangles, mesh.vertex_count());
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
        cloth.rest_positions.emplace_back(mesh.positions[3 * v], mesh.positions[3 * v + 1], mesh.positions[3 * v + 2]);
    for (const auto& [i, j, k] : mesh.triangles) {
        const Eigen::Vector3d& x = cloth.rest_positions[i];
        cloth.rest_areas.push_back(0.5 * (cloth.rest_positions[j] - x).cross(cloth.rest_positions[k] - x).norm());
    }
    cloth.inverse_masses.assign(mesh.vertex_count(), 1.0);
    for (const std::uint32_t v : pinned) cloth.inverse_masses[v] = 0.0;
    cloth.time_step = 0.1;
    return cloth;
}

Cloth hanging_grid(std::uint32_t columns) {
    return cloth_of(grid(columns, columns, 1.0, 1.0, Diagonals::alternating), {0, columns - 1});
}

Positions rest_of(const Cloth& cloth) {
    Positions positions;
    for (const Eigen::Vector3d& x : cloth.rest_positions) positions.push_back(x.cast<float>());
    return positions;
}

Positions stretched(const Cloth& cloth, float factor) {
    Positions positions = rest_of(cloth);
    for (Eigen::Vector3f& x : positions) x = {x.x(), 0.05f * std::sin(9.0f * x.x() + 5.0f * x.z()), factor * x.z()};
    return positions;
}

Positions projected(const Cloth& cloth, const std::string& method, Positions positions,
                    std::vector<methods::Parameter> parameters) {
    methods::make_method(method, cloth, parameters)->project(positions);
    return positions;
}

float area(const Triangle& t, const Positions& positions) {
    return 0.5f * (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]).norm();
}

float greatest_area_change(const Cloth& cloth, const Positions& positions) {
    float greatest = 0.0f;
    for (std::size_t a = 0; a < cloth.rest_areas.size(); ++a) {
        const auto rest = static_cast<float>(cloth.rest_areas[a]);
        greatest = std::max(greatest, std::abs(area(cloth.topology->triangles()[a], positions) - rest) / rest);
    }
    return greatest;
}

namespace {

std::vector<float> edge_ratios(const Cloth& cloth, const Positions& positions) {
    std::vector<float> ratios;
    for (const auto& [a, b] : cloth.topology->edges())
        ratios.push_back((positions[b] - positions[a]).norm() /
                         static_cast<float>((cloth.rest_positions[b] - cloth.rest_positions[a]).norm()));
    return ratios;
}

}  // namespace

float greatest_edge_ratio(const Cloth& cloth, const Positions& positions) {
    return std::ranges::max(edge_ratios(cloth, positions));
}

float least_edge_ratio(const Cloth& cloth, const Positions& positions) {
    return std::ranges::min(edge_ratios(cloth, positions));
}

Eigen::Vector3d first_moment(const Cloth& cloth, const Positions& positions) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t v = 0; v < positions.size(); ++v)
        if (cloth.inverse_masses[v] > 0.0) sum += positions[v].cast<double>() / cloth.inverse_masses[v];
    return sum;
}

bool same_bytes(const Positions& left, const Positions& right) {
    return left.size() == right.size() &&
           std::memcmp(left.data(), right.data(), left.size() * sizeof(Eigen::Vector3f)) == 0;
}

}  // namespace apsl::test
