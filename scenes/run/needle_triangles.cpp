// SPDX-License-Identifier: MIT
#include "run/needle_triangles.hpp"

#include "pipeline/geometry.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>

namespace apsl::scenes {

NeedleTriangles needle_triangles(const ClothState& cloth) {
    NeedleTriangles needles;
    double longest_of_needles = 0.0;
    double shortest_of_others = std::numeric_limits<double>::infinity();
    const auto triangles = cloth.topology->triangles();
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const auto [shortest, middle, longest] = sorted_edge_lengths(cloth.rest_positions, triangles[t]);
        const double ratio = shortest / longest;
        if (ratio < needles.shortest_over_longest) {
            needles.shortest_over_longest = ratio;
            needles.sharpest = t;
        }
        if (ratio < needle_edge) {
            ++needles.count;
            longest_of_needles = std::max(longest_of_needles, shortest);
        } else {
            shortest_of_others = std::min(shortest_of_others, shortest);
        }
    }
    // So much more that it does not matter how the text of it is rounded.
    const double distance = 1.1 * longest_of_needles;
    const bool some = needles.count > 0 && needles.count < triangles.size();
    if (some && 1.1 * distance < shortest_of_others) needles.weld_distance = distance;
    return needles;
}

std::optional<std::string> needle_triangles_warning(const NeedleTriangles& needles, bool from_file) {
    if (needles.count == 0) return std::nullopt;
    char part[32];
    std::snprintf(part, sizeof part, "1/%.0f", 1.0 / needles.shortest_over_longest);
    const std::string text = "triangles with one edge much shorter than the others: " + std::to_string(needles.count) +
                             " (sharpest: triangle " + std::to_string(needles.sharpest) + ", shortest edge " + part +
                             " of its longest); they stretch across it whatever the limiter does, ";
    if (!from_file || !needles.weld_distance) return text + "collapse their shortest edges in the mesh";
    char distance[32];
    std::snprintf(distance, sizeof distance, "%.1e", *needles.weld_distance);
    return text + "join those vertices: write \"weld\": " + distance + " (m) beside \"file\" in mesh";
}

}  // namespace apsl::scenes
