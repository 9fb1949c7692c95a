// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <variant>

namespace apsl::scenes {

struct Held {};

struct Translation {
    std::array<double, 3> velocity{};  ///< m/s
};

struct Rotation {
    std::array<double, 3> axis{0.0, 1.0, 0.0};  ///< any length but zero; turns by the right-hand rule
    double degrees_per_second = 0.0;            ///< degree/s
    /// m, a point of the axis; none: the middle of what turns, see Pins and MovingCollider.
    std::optional<std::array<double, 3>> center{};
};

/// How pinned vertices or a collider move, as a scene prescribes it.
struct Motion {
    std::variant<Held, Translation, Rotation> path;
    double start = 0.0;                                     ///< s, at rest before
    double stop = std::numeric_limits<double>::infinity();  ///< s, at rest after, ≥ start
};

/// What is wrong with it: a zero axis, numbers that are not finite, stop < start. Empty where nothing is.
std::string fault_of(const Motion& motion);

/// Whether it ever moves anything.
bool moves(const Motion& motion);

/// s, in motion at `time`.
double seconds_in_motion(const Motion& motion, double time);

/// Where the path carries `place` (m) in so many seconds in motion, backwards where they are negative; the same bits
/// where they are none. A rotation has its center.
std::array<double, 3> carried(const Motion& motion, const std::array<double, 3>& place, double seconds);

}  // namespace apsl::scenes
