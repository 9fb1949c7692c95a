// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"
#include "pipeline/motion.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace apsl::scenes {

struct PinGroup {
    std::vector<std::uint32_t> vertices;
    Motion motion;  ///< a rotation without a center turns about the centroid of the group's rest positions
};

/// The vertices of all groups, ascending, each once: what make_cloth_state wants.
std::vector<std::uint32_t> pinned_vertices(std::span<const PinGroup> groups);

/// Where pinned vertices go. A vertex named by several groups follows the last of them.
class Pins {
public:
    /// Throws Error(invalid_argument), naming the group: a vertex out of range or not pinned in `cloth`, a zero axis,
    /// numbers that are not finite, stop < start.
    Pins(const ClothState& cloth, std::vector<PinGroup> groups);

    /// Gives pinned vertices the velocity (x(time + Δt) − x) / Δt, so that x + Δt v is the prescribed place and errors
    /// never add up. Exactly zero where the place does not change: such a vertex does not move by one bit.
    /// `time`: s, the start of the step. Throws Error(invalid_argument) unless time_step > 0.
    void set_velocities(ClothState& cloth, double time, double time_step) const;

    /// Whether any group ever moves.
    bool moving() const noexcept;

private:
    std::vector<PinGroup> groups_;
};

}  // namespace apsl::scenes
