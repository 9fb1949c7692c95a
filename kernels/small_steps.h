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

// The share of the start's area error, and of its excess of stretch, that stays for now.
APSLK_INLINE float start_error_left(int sub_step, int small_steps) {
    const int planned = small_steps - (APSLK_LIMITS_STRETCH ? APSLK_PARTS_OF_LEAD : 1) * (sub_step + 1);
    return planned > 0 ? (float)planned / (float)small_steps : 0.0f;
}

#endif
