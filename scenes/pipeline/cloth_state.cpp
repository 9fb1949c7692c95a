// SPDX-License-Identifier: MIT
#include "pipeline/cloth_state.hpp"

#include "pipeline/geometry.hpp"

#include <apsl/error.hpp>

#include <cmath>
#include <string>
#include <utility>

namespace apsl::scenes {

namespace {

void check_positions(std::span<const double> positions, std::size_t vertex_count) {
    if (positions.size() != 3 * vertex_count) {
        throw Error(ErrorCode::invalid_argument, "cloth: expected " + std::to_string(3 * vertex_count) +
                                                     " rest position coordinates (3 a vertex), got " +
                                                     std::to_string(positions.size()));
    }
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (!std::isfinite(positions[i])) {
            throw Error(ErrorCode::invalid_argument,
                        "cloth: the rest position of vertex " + std::to_string(i / 3) + " is not finite");
        }
    }
}

}  // namespace

ClothState make_cloth_state(std::shared_ptr<const Topology> topology, std::span<const double> rest_positions,
                            double density, std::span<const std::uint32_t> pinned_vertices) {
    if (!topology) throw Error(ErrorCode::invalid_argument, "cloth: expected a topology, got none");
    const std::size_t vertex_count = topology->vertex_count();
    check_positions(rest_positions, vertex_count);
    if (!(density > 0.0) || !std::isfinite(density)) {
        throw Error(ErrorCode::invalid_argument,
                    "cloth: density must be positive and finite (kg/m²), got " + std::to_string(density));
    }

    ClothState cloth;
    cloth.positions.assign(rest_positions.begin(), rest_positions.end());
    cloth.rest_positions = cloth.positions;
    cloth.velocities.assign(3 * vertex_count, 0.0);
    cloth.masses.assign(vertex_count, 0.0);
    cloth.inverse_masses.assign(vertex_count, 0.0);
    cloth.rest_areas.reserve(topology->triangle_count());
    for (const Triangle& triangle : topology->triangles()) {
        const double area = triangle_area(rest_positions, triangle);
        cloth.rest_areas.push_back(area);
        for (const std::uint32_t vertex : triangle) cloth.masses[vertex] += density * area / 3.0;
    }

    std::vector<bool> pinned(vertex_count, false);
    for (const std::uint32_t vertex : pinned_vertices) {
        if (vertex >= vertex_count) {
            throw Error(ErrorCode::invalid_argument, "cloth: pinned vertex " + std::to_string(vertex) +
                                                         " is out of range, the mesh has " +
                                                         std::to_string(vertex_count) + " vertices");
        }
        pinned[vertex] = true;
    }
    const auto corner_offsets = topology->corner_offsets();
    for (std::size_t vertex = 0; vertex < vertex_count; ++vertex) {
        const bool isolated = corner_offsets[vertex] == corner_offsets[vertex + 1];
        if (pinned[vertex] || isolated) continue;
        cloth.inverse_masses[vertex] = 1.0 / cloth.masses[vertex];
        if (!std::isfinite(cloth.inverse_masses[vertex]) || !std::isfinite(cloth.masses[vertex])) {
            throw Error(ErrorCode::invalid_mesh, "cloth: the triangles at vertex " + std::to_string(vertex) +
                                                     " have no usable area, so it has no mass; remove them or pin it");
        }
    }
    cloth.topology = std::move(topology);
    return cloth;
}

}  // namespace apsl::scenes
