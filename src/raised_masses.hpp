// SPDX-License-Identifier: MIT
#pragma once

#include "../kernels/constants.h"

namespace apsl {

// docs/formulation.md, Effective masses.
inline constexpr float mass_per_stiffness = APSLK_MASS_PER_STIFFNESS;
inline constexpr float stiffness_kept = APSLK_STIFFNESS_KEPT;
inline constexpr float greatest_mean_masses = APSLK_GREATEST_MEAN_MASSES;

}  // namespace apsl
