// SPDX-License-Identifier: MIT
#pragma once

#include "run/scene.hpp"
#include "run/scene_object.hpp"

namespace apsl::scenes {

/// Parts of a scene that select vertices, as parse_scene wants them: an entry of `pins`, an entry of `masses`.
/// The motion of a pin or a collider. All throw InputError as it does.
Motion parse_motion(SceneObject object);
Pin parse_pin(SceneObject object);
MassFactor parse_mass_factor(SceneObject object);

}  // namespace apsl::scenes
