// SPDX-License-Identifier: MIT
#pragma once

#include "run/report.hpp"

#include <cstddef>
#include <optional>
#include <span>

namespace apsl::scenes {

/// Frames at the start of a run that are for settling: a cloth may start far from rest.
inline constexpr std::size_t settling_frames = 10;

/// What a limiter holds of a cloth that has settled: the greatest over frames.
struct SettledMeasures {
    double max_area_change = 0.0;
    double max_edge_stretch = 1.0;
    double max_principal_stretch = 1.0;
};

/// Over the frames after the first settling_frames; none where there are no such frames.
std::optional<SettledMeasures> settled_measures(std::span<const FrameReport> frames);

}  // namespace apsl::scenes
