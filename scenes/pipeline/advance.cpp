// SPDX-License-Identifier: MIT
#include "pipeline/advance.hpp"

#include <cstddef>

namespace apsl::scenes {

void advance_positions(ClothState& cloth, double time_step) {
    for (std::size_t i = 0; i < cloth.positions.size(); ++i) cloth.positions[i] += time_step * cloth.velocities[i];
}

}  // namespace apsl::scenes
