// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

#include <cstdint>
#include <vector>

namespace apsl::methods {

/// The way over the cloth at rest from a vertex to a pin.
struct PinDistance {
    std::uint32_t vertex;
    std::uint32_t pin;
    double length;  ///< m
};

/// For each island of pins (pinned vertices that edges connect), in the order of their first vertex: every free vertex
/// that edges connect with it, ascending, with the island's nearest pin.
///
/// Lengths are geodesic as those of our own tethers are (src/ways_to_pins.hpp): exact on a flat sheet wherever the
/// straight way stays on it. Dijkstra along the edges alone is up to 8 % too long there.
std::vector<std::vector<PinDistance>> unfolded_distances(const Cloth& cloth);

}  // namespace apsl::methods
