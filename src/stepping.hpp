// SPDX-License-Identifier: MIT
#pragma once

#include "../kernels/constants.h"

#include <algorithm>
#include <cmath>

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

/// What a call of this number of sub-steps, the last with this greatest effective mass over the one given, asks of the
/// next. `asked`: of itself.
inline float next_asked_sub_steps(float asked, int sub_steps, float mass_ratio) {
    const float by_tension =
        static_cast<float>(sub_steps) * std::sqrt((mass_ratio - 1.0f) / (APSLK_AIMED_MASS_RATIO - 1.0f));
    return std::max(APSLK_ASKED_KEPT * asked, by_tension);
}

/// How fast, a step, a sub-step asks again for an excess that it could not take. `asked`: by the calls before, which
/// count where sub-steps follow them.
inline float excess_asked_again(float asked, int sub_steps, int most_sub_steps) {
    if (most_sub_steps <= sub_steps) return APSLK_EXCESS_ASKED_AGAIN;
    const float tension = asked * asked / (static_cast<float>(sub_steps) * static_cast<float>(sub_steps));
    return APSLK_EXCESS_ASKED_AGAIN * std::clamp(APSLK_LITTLE_TENSION / tension, 1.0f, 2.0f);
}

}  // namespace apsl
