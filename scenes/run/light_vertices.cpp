// SPDX-License-Identifier: MIT
#include "run/light_vertices.hpp"

#include "pipeline/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

namespace apsl::scenes {
namespace {

// Above this part of the median edge a short edge is no flaw of the mesh, and collapsing it would coarsen the cloth.
constexpr double short_edge = 0.5;

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// The next number of two digits above.
double rounded_up(double value) {
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
    return std::ceil(value * (1.0 + 1e-6) / unit) * unit;
}

// A light vertex goes with its shortest edge; so the longest of those that are short.
std::optional<double> collapse_length(const ClothState& cloth, double light_mass) {
    const auto edges = cloth.topology->edges();
    std::vector<double> shortest(cloth.masses.size(), std::numeric_limits<double>::infinity());
    std::vector<double> lengths;
    lengths.reserve(edges.size());
    for (const VertexPair& edge : edges) {
        lengths.push_back(edge_length(cloth.rest_positions, edge));
        for (const std::uint32_t vertex : edge) shortest[vertex] = std::min(shortest[vertex], lengths.back());
    }
    if (lengths.empty()) return std::nullopt;
    const double short_length = short_edge * median(lengths);
    double longest = 0.0;
    for (std::size_t v = 0; v < shortest.size(); ++v) {
        const bool light = cloth.inverse_masses[v] > 0.0 && cloth.masses[v] < light_mass;
        if (light && shortest[v] < short_length) longest = std::max(longest, shortest[v]);
    }
    if (!(longest > 0.0)) return std::nullopt;
    return rounded_up(longest);
}

std::string length_text(double length) {
    char text[32];
    const bool small = length < 0.0995;
    std::snprintf(text, sizeof text, "%.2g %s", small ? 1e3 * length : length, small ? "mm" : "m");
    return text;
}

}  // namespace

LightVertices light_vertices(const ClothState& cloth) {
    LightVertices light;
    std::vector<double> movable;
    for (std::uint32_t v = 0; v < cloth.masses.size(); ++v) {
        if (!(cloth.inverse_masses[v] > 0.0)) continue;
        if (movable.empty() || cloth.masses[v] < cloth.masses[light.lightest]) light.lightest = v;
        movable.push_back(cloth.masses[v]);
    }
    if (movable.empty()) return light;
    const double middle = median(movable);
    light.share_of_median = cloth.masses[light.lightest] / middle;
    light.count = static_cast<std::size_t>(
        std::count_if(movable.begin(), movable.end(), [&](double mass) { return mass < light_mass_ratio * middle; }));
    if (light.count > 0) light.shorter_than = collapse_length(cloth, light_mass_ratio * middle);
    return light;
}

std::string lightest_text(const LightVertices& light) {
    char share[32];
    std::snprintf(share, sizeof share, light.share_of_median < 0.095 ? "1/%.0f" : "%.2g",
                  light.share_of_median < 0.095 ? 1.0 / light.share_of_median : light.share_of_median);
    return "vertex " + std::to_string(light.lightest) + ", " + share + " of the median mass";
}

std::string light_vertices_advice(const LightVertices& light) {
    if (!light.shorter_than) return "give them more mass";
    return "collapse edges under " + length_text(*light.shorter_than) + ", or give them more mass";
}

std::optional<std::string> light_vertices_warning(const LightVertices& light) {
    if (light.count == 0) return std::nullopt;
    return "movable vertices with less than 1/30 of the median mass: " + std::to_string(light.count) +
           " (lightest: " + lightest_text(light) + "); they give way to every force, " + light_vertices_advice(light);
}

}  // namespace apsl::scenes
