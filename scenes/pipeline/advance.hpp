// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"

namespace apsl::scenes {

/// x ← x + Δt v for every vertex. A pinned vertex at rest keeps its bits.
void advance_positions(ClothState& cloth, double time_step);

}  // namespace apsl::scenes
