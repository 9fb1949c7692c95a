// SPDX-License-Identifier: MIT
// How small steps divide a time step (docs/formulation.md, Small steps). Reference: stepping.hpp.
#ifndef APSL_SMALL_STEPS_H
#define APSL_SMALL_STEPS_H

#include "layout.h"

// Positions are those at the end of the step, in and out; there are no velocities.
#ifndef APSL_POSITIONS_ONLY
#define APSL_POSITIONS_ONLY 0
#endif

// A small step asks a triangle for at most this multiple of its present area: from nearly nothing a linearised step
// overshoots without bound.
#define APSL_GREATEST_GROWTH 4.0f

// Sub-steps that move on by a part of Δt: none where there are no velocities, which the compiler then knows.
APSL_INLINE int walked_sub_steps(apsl_parameters parameters) {
    return APSL_POSITIONS_ONLY ? 0 : parameters.walked;
}

// The share of the start's area error that stays for now.
APSL_INLINE float start_error_left(int sub_step, int walked) {
    return sub_step < walked ? (float)(walked - 1 - sub_step) / (float)walked : 0.0f;
}

#endif
