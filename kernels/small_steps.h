// SPDX-License-Identifier: MIT
// How small steps divide a time step (docs/formulation.md, Small steps). Reference: stepping.hpp.
#ifndef APSLK_SMALL_STEPS_H
#define APSLK_SMALL_STEPS_H

#include "layout.h"
#include "limits_stretch.h"

// Positions are those at the end of the step, in and out; there are no velocities.
#ifndef APSLK_POSITIONS_ONLY
#define APSLK_POSITIONS_ONLY 0
#endif

// Sub-steps that move on by a part of Δt: none where there are no velocities, which the compiler then knows.
APSLK_INLINE int small_step_count(apslk_parameters parameters) {
    return APSLK_POSITIONS_ONLY ? 0 : parameters.small_steps;
}

// The sub-steps that a whole step with this greatest excess of stretch asks for, or `asked` by the calls before; at
// least those given.
APSLK_INLINE int followed_sub_steps(float excess, float asked, apslk_parameters parameters) {
    const float wanted = ceil(fmax(excess / APSLK_EXCESS_A_SUB_STEP, asked));
    return wanted < (float)parameters.most_sub_steps ? max((int)wanted, parameters.sub_steps)
                                                     : parameters.most_sub_steps;
}

// What a call of this number of sub-steps, the last with this greatest effective mass over the one given, asks of the
// next. `asked`: of itself.
APSLK_INLINE float next_asked_sub_steps(float asked, int sub_steps, float mass_ratio) {
    const float by_tension = (float)sub_steps * sqrt((mass_ratio - 1.0f) / (APSLK_AIMED_MASS_RATIO - 1.0f));
    return fmax(APSLK_ASKED_KEPT * asked, by_tension);
}

// How fast, a step, a sub-step asks again for an excess that it could not take. `asked`: by the calls before, which
// count where sub-steps follow them.
APSLK_INLINE float excess_asked_again(float asked, int sub_steps, int most_sub_steps) {
    if (most_sub_steps <= sub_steps) return APSLK_EXCESS_ASKED_AGAIN;
    const float tension = asked * asked / ((float)sub_steps * (float)sub_steps);
    return APSLK_EXCESS_ASKED_AGAIN * clamp(APSLK_LITTLE_TENSION / tension, 1.0f, 2.0f);
}

// The share of the start's area error that stays for now.
APSLK_INLINE float start_error_left(int sub_step, int small_steps) {
    const int planned = small_steps - (APSLK_LIMITS_STRETCH ? APSLK_PARTS_OF_LEAD : 1) * (sub_step + 1);
    return planned > 0 ? (float)planned / (float)small_steps : 0.0f;
}

#endif
