// SPDX-License-Identifier: MIT
#pragma once

#include "run/custom_filter.hpp"
#include "run/scene.hpp"

namespace apsl::compare {

/// Algorithm 1 in double precision with the consistent matrix, each sub-step solved by a sparse LDLᵀ factorisation in
/// place of Conjugate Gradient: what sub-steps and α alone leave. tolerance, max_iterations and adaptive_threshold
/// have no meaning here. A zero pivot (α = 1 can bring one about) and numbers that are not finite leave the velocities
/// as they were: Status::diverged.
scenes::CustomFilter make_direct_filter(const scenes::ClothState& cloth, const scenes::StrainLimiting& settings);

}  // namespace apsl::compare
