// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"
#include "methods/tethered_distances.hpp"
#include "run/custom_step.hpp"

#include <span>

namespace apsl::compare {

// Methods as whole integrators: steps in 32 bits, from the cloth's positions and velocities to those of the step's end.
// What is not finite going in or coming out leaves the cloth as it was: Status::diverged.

/// Of methods::TetheredDistances. Throws Error(invalid_argument) for settings out of range.
scenes::CustomStep make_tethers_step(const methods::TetherSettings& settings, const scenes::ClothState& cloth,
                                     double time_step);

/// How a baseline takes a step of its own.
struct SmallSteps {
    int count = 20;                                     ///< a step, ≥ 1
    double damping = 0.0;                               ///< 1/s
    Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< m/s²
};

/// Of a baseline in small steps h (Macklin et al. 2019): v ← (v + h g) e^(−d h), x ← x + h v, project, v ← v + Δx / h.
/// Throws Error(invalid_argument) for parameters that the method does not have or values out of range.
scenes::CustomStep make_baseline_step(const methods::MethodInfo& method, std::span<const methods::Parameter> parameters,
                                      const SmallSteps& steps, const scenes::ClothState& cloth, double time_step);

}  // namespace apsl::compare
