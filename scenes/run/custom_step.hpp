// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"

#include <apsl/stats.hpp>

#include <functional>
#include <string>

namespace apsl::scenes {

/// Another integrator in place of a stand-alone limiter, for comparisons: a whole step of the cloth, positions and
/// velocities, gravity and damping its own. Pinned vertices go by their velocity; it knows no colliders. Of the Stats
/// it returns the area changes are not looked at: the simulation measures them itself, outside the step's time.
/// Status::diverged ends the simulation.
struct CustomStep {
    std::string name;    ///< in the list of stages
    std::string device;  ///< what it runs on
    std::function<Stats(ClothState&)> step;
};

}  // namespace apsl::scenes
