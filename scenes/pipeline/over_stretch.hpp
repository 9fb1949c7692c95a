// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"

#include <string>
#include <vector>

namespace apsl::scenes {

/// Length over rest length above which an edge counts as over-stretched.
inline constexpr double over_stretch_ratio = 1.5;

/// A triangle with an over-stretched edge, in the frame in which that edge was longest.
struct OverStretchedTriangle {
    std::uint32_t triangle = 0;
    int frame = 0;
    double edge_stretch = 0.0;  ///< of its longest edge
    double area_change = 0.0;   ///< |A − A⁰| / A⁰ then; 0 where A⁰ is 0
};

/// Follows through a run which triangles cannot be held: a limit on area leaves edges free.
class OverStretch {
public:
    /// Looks at the current positions. The cloth is the same in all calls.
    void measure(const ClothState& cloth, int frame);

    /// All of the run, the longest edge first.
    std::vector<OverStretchedTriangle> triangles() const;

private:
    std::vector<OverStretchedTriangle> greatest_;  // [T] once there is one; edge_stretch 0 where there was none
};

/// Why a triangle's edges give way, in words: by which pinned vertex it hangs, how many triangles share the load there,
/// or how far the nearest one is. `limits_stretch`: there is a stretch ceiling, which did not hold it.
std::string over_stretch_cause(const ClothState& cloth, std::uint32_t triangle, bool limits_stretch);

}  // namespace apsl::scenes
