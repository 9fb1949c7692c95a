// SPDX-License-Identifier: MIT
#pragma once

#include "run/mesh.hpp"
#include "run/scene.hpp"

#include <vector>

namespace apsl::scenes {

/// The vertices that each pin of the scene selects on a mesh. Throws InputError naming the pin: a vertex out of range,
/// a corner that is none, a box without a vertex in it.
std::vector<PinGroup> resolve_pins(const Scene& scene, const Mesh& mesh);

}  // namespace apsl::scenes
