// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"
#include "pipeline/springs.hpp"

#include <array>
#include <span>

namespace apsl::test {

/// Σ ½ m |v|², J.
double kinetic_energy(const scenes::ClothState& cloth);

/// Of gravity (m/s²), −Σ m g·x, and of the springs, Σ ½ k (|x_b − x_a| − L)², at the current positions, J.
double potential_energy(const scenes::ClothState& cloth, std::span<const scenes::Spring> springs,
                        const std::array<double, 3>& gravity);

}  // namespace apsl::test
