// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"

#include <apsl/parameters.hpp>

namespace apsl::scenes {

/// Parameters::bending_iterations that the mean triangle of a cloth needs to be as stiff as Parameters::bending says,
/// at most 32: a hinge that needs more is softer.
int bending_iterations(const ClothState& cloth, const Parameters& parameters);

}  // namespace apsl::scenes
