// SPDX-License-Identifier: MIT
#include "run/pieces.hpp"

#include "pipeline/geometry.hpp"
#include "run/weld.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <numeric>
#include <vector>

namespace apsl::scenes {
namespace {

// Of the cloth's extent. Layers of cloth lie farther apart, and what is the same number in a file lies nearer.
constexpr double one_place = 1e-6;

bool has_triangles(const Topology& topology, std::size_t vertex) {
    const auto offsets = topology.corner_offsets();
    return offsets[vertex] != offsets[vertex + 1];
}

// Positions of the vertices that have triangles.
std::vector<double> places(const ClothState& cloth) {
    std::vector<double> positions;
    positions.reserve(cloth.rest_positions.size());
    for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v) {
        if (!has_triangles(*cloth.topology, v)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) positions.push_back(cloth.rest_positions[3 * v + axis]);
    }
    return positions;
}

// m; infinite where all edges have length 0.
double shortest_edge(const ClothState& cloth) {
    double shortest = std::numeric_limits<double>::infinity();
    for (const VertexPair& edge : cloth.topology->edges()) {
        const double length = edge_length(cloth.rest_positions, edge);
        if (length > 0.0) shortest = std::min(shortest, length);
    }
    return shortest;
}

// The next power of ten, unless that would close edges too.
double weld_distance(double distance, double shortest) {
    const double round = std::pow(10.0, std::ceil(std::log10(distance)));
    return round < shortest ? round : distance;
}

}  // namespace

Pieces pieces_of(const ClothState& cloth) {
    const Topology& topology = *cloth.topology;
    std::vector<std::uint32_t> parent(topology.vertex_count());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const Triangle& triangle : topology.triangles())
        for (const std::uint32_t vertex : triangle) parent[root(vertex)] = root(triangle[0]);
    std::vector<bool> pinned(topology.vertex_count(), false);
    for (std::uint32_t v = 0; v < topology.vertex_count(); ++v)
        if (cloth.inverse_masses[v] == 0.0) pinned[root(v)] = true;
    Pieces pieces;
    for (std::uint32_t v = 0; v < topology.vertex_count(); ++v) {
        if (!has_triangles(topology, v) || root(v) != v) continue;
        ++pieces.count;
        if (!pinned[v]) ++pieces.without_pin;
    }
    return pieces;
}

std::optional<std::string> coincidence_warning(const ClothState& cloth, const Pieces& pieces) {
    const std::vector<double> positions = places(cloth);
    const double shortest = shortest_edge(cloth);
    const double distance = std::min(one_place * extent(positions), 0.5 * shortest);
    if (!(distance > 0.0) || !std::isfinite(distance)) return {};
    const std::vector<std::uint32_t> first = first_within(positions, distance);
    std::size_t coincident = 0;
    for (std::size_t v = 0; v < first.size(); ++v) coincident += first[v] != v;
    if (coincident == 0) return {};
    char suggestion[32];
    std::snprintf(suggestion, sizeof suggestion, "%.0e", weld_distance(distance, shortest));
    std::string text = "vertices in the place of another: " + std::to_string(coincident) + "; the cloth is in " +
                       std::to_string(pieces.count) + (pieces.count == 1 ? " piece" : " pieces, ");
    if (pieces.count > 1) text += std::to_string(pieces.without_pin) + " of them without a pin,";
    return text + " and comes apart there; to join them, write \"weld\": " + suggestion +
           " (m) beside \"file\" in mesh";
}

}  // namespace apsl::scenes
