// SPDX-License-Identifier: MIT
#include "run/cap_triangles.hpp"

#include "pipeline/geometry.hpp"

#include <cstdio>

namespace apsl::scenes {
namespace {

// Of the longest edge. A triangle with a shorter edge is rather a needle, which is told of apart.
constexpr double short_edge = 0.1;

}  // namespace

CapTriangles cap_triangles(const ClothState& cloth) {
    CapTriangles caps;
    const auto triangles = cloth.topology->triangles();
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const auto [shortest, middle, longest] = sorted_edge_lengths(cloth.rest_positions, triangles[t]);
        if (!(shortest > short_edge * longest)) continue;
        const double height = 2.0 * triangle_area(cloth.rest_positions, triangles[t]) / (longest * longest);
        if (height < cap_height) ++caps.count;
        if (height < caps.height) {
            caps.height = height;
            caps.flattest = t;
        }
    }
    return caps;
}

std::string cap_triangles_advice(const CapTriangles& caps) {
    const std::string others = caps.count > 1 ? " and of those like it" : "";
    return "flip the longest edge of triangle " + std::to_string(caps.flattest) + others + " in the mesh";
}

std::optional<std::string> cap_triangles_warning(const CapTriangles& caps) {
    if (caps.count == 0) return std::nullopt;
    char height[32];
    std::snprintf(height, sizeof height, "1/%.0f", 1.0 / caps.height);
    return "triangles with a corner close to the opposite edge: " + std::to_string(caps.count) +
           " (flattest: triangle " + std::to_string(caps.flattest) + ", height " + height +
           " of its longest edge); their areas are hard to hold, " + cap_triangles_advice(caps);
}

}  // namespace apsl::scenes
