// SPDX-License-Identifier: MIT
#include "run/settled.hpp"

#include <algorithm>

namespace apsl::scenes {

std::optional<SettledMeasures> settled_measures(std::span<const FrameReport> frames) {
    if (frames.size() <= settling_frames) return std::nullopt;
    SettledMeasures settled;
    for (const FrameReport& frame : frames.subspan(settling_frames)) {
        settled.max_area_change = std::max(settled.max_area_change, frame.max_area_change);
        settled.max_edge_stretch = std::max(settled.max_edge_stretch, frame.max_edge_stretch);
        settled.max_principal_stretch = std::max(settled.max_principal_stretch, frame.max_principal_stretch);
    }
    return settled;
}

}  // namespace apsl::scenes
