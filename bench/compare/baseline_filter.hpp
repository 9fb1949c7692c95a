// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"
#include "run/custom_filter.hpp"
#include "run/scene.hpp"

#include <span>

namespace apsl::compare {

/// A baseline where the filter stands: predict x̃ + Δt ṽ in 32 bits, project, ṽ ← ṽ + (x − predicted) / Δt for the free
/// vertices. What is not finite going in or coming out leaves the velocities as they were: Status::diverged.
/// Throws Error(invalid_argument) for parameters that the method does not have or values out of range.
scenes::CustomFilter make_baseline_filter(const methods::MethodInfo& method,
                                          std::span<const methods::Parameter> parameters,
                                          const scenes::ClothState& cloth, double time_step);

}  // namespace apsl::compare
