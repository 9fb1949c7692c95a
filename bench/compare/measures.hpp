// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"

#include <array>
#include <span>
#include <vector>

namespace apsl::compare {

/// Distance of each vertex from where it should be: m.
struct Deviation {
    double rms = 0.0;
    double max = 0.0;
};
/// Of positions from others of the same size: m, [3V], V ≥ 1.
Deviation deviation(std::span<const double> positions, std::span<const double> expected);

/// m, mean over the free vertices of the way from their rest positions; zero where there are none.
std::array<double, 3> mean_displacement(const scenes::ClothState& cloth);

}  // namespace apsl::compare
