// SPDX-License-Identifier: MIT
#include "pipeline/springs.hpp"

#include "pipeline/geometry.hpp"

#include <apsl/error.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace apsl::scenes {

namespace {

void check(const Topology& topology, std::span<const double> rest_positions, double stiffness) {
    if (rest_positions.size() != 3 * topology.vertex_count()) {
        throw Error(ErrorCode::invalid_argument, "springs: expected " + std::to_string(3 * topology.vertex_count()) +
                                                     " rest position coordinates (3 a vertex), got " +
                                                     std::to_string(rest_positions.size()));
    }
    if (!(stiffness >= 0.0) || !std::isfinite(stiffness)) {
        throw Error(ErrorCode::invalid_argument,
                    "springs: stiffness must be finite and ≥ 0 (N/m), got " + std::to_string(stiffness));
    }
}

}  // namespace

Spring make_spring(std::uint32_t a, std::uint32_t b, std::span<const double> rest_positions, double stiffness) {
    const double rest_length = (vector_at(rest_positions, b) - vector_at(rest_positions, a)).norm();
    return {.a = std::min(a, b), .b = std::max(a, b), .rest_length = rest_length, .stiffness = stiffness};
}

std::vector<Spring> stretch_springs(const Topology& topology, std::span<const double> rest_positions,
                                    double stiffness) {
    check(topology, rest_positions, stiffness);
    std::vector<Spring> springs;
    springs.reserve(topology.edges().size());
    for (const auto& [a, b] : topology.edges()) springs.push_back(make_spring(a, b, rest_positions, stiffness));
    return springs;
}

std::vector<Spring> bending_springs(const Topology& topology, std::span<const double> rest_positions,
                                    double stiffness) {
    check(topology, rest_positions, stiffness);
    const auto vertex_at = [&](Corner corner) { return topology.triangles()[corner / 3][corner % 3]; };
    const auto offsets = topology.edge_corner_offsets();
    const auto corners = topology.edge_corners();
    std::vector<Spring> springs;
    for (std::size_t edge = 0; edge < topology.edges().size(); ++edge) {
        for (std::uint32_t first = offsets[edge]; first < offsets[edge + 1]; ++first) {
            for (std::uint32_t second = first + 1; second < offsets[edge + 1]; ++second) {
                const std::uint32_t a = vertex_at(corners[first]);
                const std::uint32_t b = vertex_at(corners[second]);
                if (a != b)  // the same triangle given twice has nothing to bend
                    springs.push_back(make_spring(a, b, rest_positions, stiffness));
            }
        }
    }
    return springs;
}

}  // namespace apsl::scenes
