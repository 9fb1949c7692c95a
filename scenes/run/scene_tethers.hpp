// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"
#include "run/scene.hpp"

#include <apsl/tethers.hpp>

#include <cstdint>

namespace apsl::scenes {

/// Options::tethers_per_vertex of a scene with tethers: one to each pinned piece, up to the nearest four.
std::uint32_t tethers_per_vertex(const ClothState& cloth);

/// As many tethers of each vertex as the options say, by the mesh as it is at rest.
Tethers scene_tethers(const ClothState& cloth, const StrainLimiting& settings);

}  // namespace apsl::scenes
