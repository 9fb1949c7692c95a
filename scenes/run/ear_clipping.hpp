// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/topology.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace apsl::scenes {

enum class PolygonCut {
    exact,     ///< the triangles cover the polygon once
    crossing,  ///< a fan of a polygon that crosses or pinches itself, or has no area: triangles may overlap
    too_long,  ///< none: a concave polygon of more corners than can be cut in a second
};

/// Cuts a polygon into n − 2 triangles of its own vertices and orientation, seen along its area vector
/// (½ Σ xₖ × xₖ₊₁): a fan from the first vertex where that covers it once, else by clipping ears (Meisters 1975). A
/// vertex may come twice, where a bridge leads to a hole. `positions`: m, [3V]; three vertices at least.
PolygonCut cut_polygon(std::span<const double> positions, std::span<const std::uint32_t> polygon,
                       std::vector<Triangle>& triangles);

}  // namespace apsl::scenes
