// SPDX-License-Identifier: MIT
// α of a solve: scheduled over the sub-steps, and adaptive (Section 4): raised where CG fails or takes too many
// iterations, restored where it takes few. Reference: scheduled_regularization and apsl::reference,
// adaptive_regularization.
#ifndef APSLK_REGULARIZATION_H
#define APSLK_REGULARIZATION_H

#include "lanes.h"
#include "layout.h"

#ifndef APSLK_REGULARIZATION_PER_TRIANGLE
#define APSLK_REGULARIZATION_PER_TRIANGLE 0
#endif

// The factor that the schedule gives α − 1. `sub_steps_left`: until the last, where it is 1; geometric.
APSLK_INLINE float scheduled_damping(float damping_step, int sub_steps_left) {
    return exp2(damping_step * (float)sub_steps_left);
}

// α as given where both factors are 1. The floor lets α = 1 be raised too.
APSLK_INLINE lanes effective_regularization(lanes given, float damping, float factor) {
    const lanes alpha = given + (damping - 1.0f) * (given - 1.0f);
    return alpha + (factor - 1.0f) * fmax(alpha - 1.0f, (lanes)(APSLK_LEAST_ADAPTED_DAMPING));
}

// ‖r‖ / ‖b‖ from their squares; the greatest number there is where a right-hand side near underflow makes it more.
APSLK_INLINE float relative_residual(float residual, float initial) {
    return fmin(sqrt(residual / initial), FLT_MAX);
}

// The factor for the next solve.
APSLK_INLINE float adapted_factor(float factor, apslk_parameters parameters, int iterations, bool converged) {
    if (parameters.adaptive_threshold == 0) return 1.0f;
    if (!converged || iterations > parameters.adaptive_threshold)
        return fmin(2.0f * factor, APSLK_GREATEST_ADAPTIVE_FACTOR);
    return 2 * iterations <= parameters.adaptive_threshold ? fmax(0.5f * factor, 1.0f) : factor;
}

#endif
