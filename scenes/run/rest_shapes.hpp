// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"

#include <vector>

namespace apsl::scenes {

/// Buffers::rest_shapes of a cloth, [4T]: of its rest positions, drawn out evenly to its rest areas where a scene says
/// other ones.
std::vector<double> rest_shapes(const ClothState& cloth);

}  // namespace apsl::scenes
