// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"
#include "pipeline/springs.hpp"

#include <array>
#include <span>

namespace apsl::scenes {

/// J. Kinetic energy and that of gravity are of the free vertices alone, gravity's is counted from the rest positions.
struct Energy {
    double kinetic = 0.0;
    double gravity = 0.0;
    double springs = 0.0;  ///< Σ ½ k (l − L)² over all springs

    double total() const { return kinetic + gravity + springs; }
};

/// Of the cloth as it is. `gravity` m/s².
Energy energy(const ClothState& cloth, std::span<const Spring> springs, const std::array<double, 3>& gravity);

/// m/s, the fastest free vertex; 0 where there is none.
double greatest_speed(const ClothState& cloth);

}  // namespace apsl::scenes
