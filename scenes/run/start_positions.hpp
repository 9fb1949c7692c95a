// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"
#include "run/scene.hpp"

namespace apsl::scenes {

/// Moves the free vertices from their rest positions to where the scene starts. Pinned ones and those in no triangle
/// stay.
void set_start_positions(const Start& start, ClothState& cloth);

}  // namespace apsl::scenes
