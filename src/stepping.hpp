// SPDX-License-Identifier: MIT
#pragma once

#include "../kernels/constants.h"

namespace apsl {

/// The fewest sub-steps for which Stepping::automatic takes small steps.
inline constexpr int least_automatic_small_steps = 20;

inline constexpr float greatest_growth = APSLK_GREATEST_GROWTH;

/// The share of the start's area error that is still there as planned after sub-step `sub_step` of small steps of
/// `parts` parts: it is led back to zero over the whole step (docs/formulation.md, Small steps), with a stretch ceiling
/// over a third of it.
inline float start_error_left(int sub_step, int parts, bool limits_stretch = false) {
    const int planned = parts - (limits_stretch ? APSLK_PARTS_OF_LEAD : 1) * (sub_step + 1);
    return planned > 0 ? static_cast<float>(planned) / static_cast<float>(parts) : 0.0f;
}

}  // namespace apsl
