// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace apsl::scenes {

struct PinHeld {};

struct PinTranslation {
    std::array<double, 3> velocity{};  ///< m/s
};

struct PinRotation {
    std::array<double, 3> axis{0.0, 1.0, 0.0};  ///< any length but zero; turns by the right-hand rule
    double degrees_per_second = 0.0;            ///< degree/s
    /// m, a point of the axis; none: centroid of the group's rest positions.
    std::optional<std::array<double, 3>> center{};
};

struct PinMotion {
    std::variant<PinHeld, PinTranslation, PinRotation> path;
    double start = 0.0;                                     ///< s, at rest before
    double stop = std::numeric_limits<double>::infinity();  ///< s, at rest after, ≥ start
};

struct PinGroup {
    std::vector<std::uint32_t> vertices;
    PinMotion motion;
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
