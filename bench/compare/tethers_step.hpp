// SPDX-License-Identifier: MIT
#pragma once

#include "methods/tethered_distances.hpp"
#include "run/custom_step.hpp"

namespace apsl::compare {

/// Steps of methods::TetheredDistances, in 32 bits, from the cloth's positions and velocities to those of the step's
/// end. What is not finite going in or coming out leaves the cloth as it was: Status::diverged.
/// Throws Error(invalid_argument) for settings out of range.
scenes::CustomStep make_tethers_step(const methods::TetherSettings& settings, const scenes::ClothState& cloth,
                                     double time_step);

}  // namespace apsl::compare
