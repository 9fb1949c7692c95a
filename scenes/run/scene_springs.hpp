// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"
#include "pipeline/springs.hpp"
#include "run/scene.hpp"

#include <string>
#include <vector>

namespace apsl::scenes {

/// The springs of a scene's integrator on its cloth at rest.
struct SceneSprings {
    std::vector<Spring> springs;
    double damping = 0.0;  ///< 1/s
    std::vector<std::string> warnings;
};

/// Empty for an integrator without springs.
SceneSprings make_scene_springs(const Scene& scene, const ClothState& cloth);

}  // namespace apsl::scenes
