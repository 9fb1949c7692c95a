// SPDX-License-Identifier: MIT
#include "run/flat_cloth.hpp"

#include <cstddef>

namespace apsl::scenes {
namespace {

// A cloth that hangs in its plane narrows too, but keeps its areas.
constexpr double short_edge = 0.8;
constexpr double area_change = 0.1;

bool lies_in_plane(const ClothState& cloth, std::size_t axis) {
    for (std::size_t k = axis; k < cloth.positions.size(); k += 3)
        if (cloth.positions[k] != cloth.positions[axis]) return false;
    return true;
}

}  // namespace

std::optional<std::string> flat_cloth_warning(const ClothState& cloth, const RunSummary& summary) {
    const bool pushed_together = summary.min_edge_stretch < short_edge && summary.max_area_change > area_change;
    if (!pushed_together || cloth.positions.empty()) return std::nullopt;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (lies_in_plane(cloth, axis))
            return std::string("the cloth was pushed together and never left the plane in which its ") + "xyz"[axis] +
                   " is the same: nothing can fold it there, and the limiter tears at it; let it start with a little "
                   "noise, \"start\": {\"random\": 1e-4} (m)";
    return std::nullopt;
}

}  // namespace apsl::scenes
