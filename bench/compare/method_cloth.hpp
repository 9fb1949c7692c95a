// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"
#include "pipeline/cloth_state.hpp"

#include <span>

namespace apsl::compare {

/// What the methods of bench/methods may know of a scene's cloth.
methods::Cloth as_method_cloth(const scenes::ClothState& cloth, double time_step);

bool all_finite(std::span<const Eigen::Vector3f> vectors);

}  // namespace apsl::compare
