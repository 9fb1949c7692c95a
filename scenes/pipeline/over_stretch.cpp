// SPDX-License-Identifier: MIT
#include "pipeline/over_stretch.hpp"

#include "pipeline/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

namespace apsl::scenes {
namespace {

bool is_pinned(const ClothState& cloth, std::uint32_t vertex) {
    return cloth.inverse_masses[vertex] == 0.0;
}

struct NearestPin {
    std::uint32_t vertex;
    int edges;
};

// Breadth first from the corners of a triangle.
std::optional<NearestPin> nearest_pin(const ClothState& cloth, const Triangle& corners) {
    const Topology& topology = *cloth.topology;
    std::vector<int> edges(topology.vertex_count(), -1);
    std::vector<std::uint32_t> reached(corners.begin(), corners.end());
    for (const std::uint32_t vertex : reached) edges[vertex] = 0;
    for (std::size_t n = 0; n < reached.size(); ++n) {
        const std::uint32_t from = reached[n];
        if (is_pinned(cloth, from)) return NearestPin{from, edges[from]};
        for (std::uint32_t c = topology.corner_offsets()[from]; c < topology.corner_offsets()[from + 1]; ++c) {
            for (const std::uint32_t to : topology.triangles()[topology.corners()[c] / 3]) {
                if (edges[to] >= 0) continue;
                edges[to] = edges[from] + 1;
                reached.push_back(to);
            }
        }
    }
    return std::nullopt;
}

}  // namespace

void OverStretch::measure(const ClothState& cloth, int frame) {
    const Topology& topology = *cloth.topology;
    for (std::size_t e = 0; e < topology.edges().size(); ++e) {
        const VertexPair edge = topology.edges()[e];
        const double rest_length = edge_length(cloth.rest_positions, edge);
        const double now = edge_length(cloth.positions, edge);
        if (!(rest_length > 0.0 && now > over_stretch_ratio * rest_length)) continue;
        greatest_.resize(topology.triangle_count());
        for (std::uint32_t c = topology.edge_corner_offsets()[e]; c < topology.edge_corner_offsets()[e + 1]; ++c) {
            const std::uint32_t triangle = topology.edge_corners()[c] / 3;
            OverStretchedTriangle& known = greatest_[triangle];
            if (now / rest_length <= known.edge_stretch) continue;
            const double rest_area = cloth.rest_areas[triangle];
            const double area = triangle_area(cloth.positions, topology.triangles()[triangle]);
            known = {triangle, frame, now / rest_length,
                     rest_area > 0.0 ? std::abs(area - rest_area) / rest_area : 0.0};
        }
    }
}

std::vector<OverStretchedTriangle> OverStretch::triangles() const {
    std::vector<OverStretchedTriangle> found;
    std::copy_if(greatest_.begin(), greatest_.end(), std::back_inserter(found),
                 [](const OverStretchedTriangle& known) { return known.edge_stretch > 0.0; });
    std::stable_sort(found.begin(), found.end(), [](const OverStretchedTriangle& a, const OverStretchedTriangle& b) {
        return a.edge_stretch > b.edge_stretch;
    });
    return found;
}

std::string over_stretch_cause(const ClothState& cloth, std::uint32_t triangle, bool limits_stretch) {
    const std::string then = limits_stretch ? ": more than its stretch ceiling held"
                                            : ": it lengthens as it narrows, which a limit on area lets it do";
    const Triangle corners = cloth.topology->triangles()[triangle];
    std::vector<std::uint32_t> pins;
    for (const std::uint32_t vertex : corners)
        if (is_pinned(cloth, vertex)) pins.push_back(vertex);
    if (pins.size() > 1) return "holds " + std::to_string(pins.size()) + " pinned vertices, which move apart";
    if (pins.empty()) {
        const std::optional<NearestPin> pin = nearest_pin(cloth, corners);
        if (!pin) return "far from any pinned vertex" + then;
        return std::to_string(pin->edges) + (pin->edges == 1 ? " edge" : " edges") + " from pinned vertex " +
               std::to_string(pin->vertex) + ", towards which the load gathers" + then;
    }
    const std::span<const std::uint32_t> offsets = cloth.topology->corner_offsets();
    const std::uint32_t sharing = offsets[pins[0] + 1] - offsets[pins[0]];
    return "hangs by pinned vertex " + std::to_string(pins[0]) +
           (sharing == 1 ? ", in no other triangle, and carries all the load there"
                         : ", one of " + std::to_string(sharing) + " triangles that carry the load there") +
           then;
}

}  // namespace apsl::scenes
