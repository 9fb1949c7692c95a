// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"

#include <apsl/stats.hpp>

#include <functional>
#include <string>

namespace apsl::scenes {

/// Another limiter in the filter's place, for comparisons: changes the cloth's velocities as the filter does, pinned
/// vertices untouched. Of the Stats it returns the area changes are not looked at: the simulation measures them itself,
/// outside the limiter's time. Status::diverged ends the simulation.
struct CustomFilter {
    std::string name;    ///< in the list of stages
    std::string device;  ///< what it runs on
    std::function<Stats(ClothState&)> filter;
};

}  // namespace apsl::scenes
