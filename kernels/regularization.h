// SPDX-License-Identifier: MIT
// α of a solve: scheduled over the sub-steps, and adaptive (Section 4): raised where CG fails or takes too many
// iterations, restored where it takes few. Reference: scheduled_regularization and apsl::reference,
// adaptive_regularization.
#ifndef APSL_REGULARIZATION_H
#define APSL_REGULARIZATION_H

#include "lanes.h"
#include "layout.h"

#ifndef APSL_REGULARIZATION_PER_TRIANGLE
#define APSL_REGULARIZATION_PER_TRIANGLE 0
#endif

// The factor that the schedule gives α − 1. `sub_steps_left`: until the last, where it is 1; geometric.
APSL_INLINE float scheduled_damping(float damping_step, int sub_steps_left) {
    return exp2(damping_step * (float)sub_steps_left);
}

// α as given where both factors are 1. The floor lets α = 1 be raised too.
APSL_INLINE lanes effective_regularization(lanes given, float damping, float factor) {
    const lanes alpha = given + (damping - 1.0f) * (given - 1.0f);
    return alpha + (factor - 1.0f) * fmax(alpha - 1.0f, (lanes)(0.05f));
}

// ‖r‖ / ‖b‖ from their squares; the greatest number there is where a right-hand side near underflow makes it more.
APSL_INLINE float relative_residual(float residual, float initial) {
    return fmin(sqrt(residual / initial), FLT_MAX);
}

// The factor for the next solve.
APSL_INLINE float adapted_factor(float factor, apsl_parameters parameters, int iterations, bool converged) {
    if (parameters.adaptive_iterations == 0) return 1.0f;
    if (!converged || iterations > parameters.adaptive_iterations) return fmin(2.0f * factor, 1024.0f);
    return 2 * iterations <= parameters.adaptive_iterations ? fmax(0.5f * factor, 1.0f) : factor;
}

#endif
