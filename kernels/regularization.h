// SPDX-License-Identifier: MIT
// Adaptive α (Section 4): raised where CG fails or takes too many iterations, restored where it takes few.
// Reference: apsl::reference, adaptive_regularization.
#ifndef APSL_REGULARIZATION_H
#define APSL_REGULARIZATION_H

#include "lanes.h"
#include "layout.h"

#ifndef APSL_REGULARIZATION_PER_TRIANGLE
#define APSL_REGULARIZATION_PER_TRIANGLE 0
#endif

// α as given where the factor is 1. The floor lets α = 1 be raised too.
APSL_INLINE lanes effective_regularization(lanes alpha, float factor) {
    return alpha + (factor - 1.0f) * fmax(alpha - 1.0f, (lanes)(0.05f));
}

// The factor for the next solve.
APSL_INLINE float adapted_factor(float factor, apsl_parameters parameters, int iterations, bool converged) {
    if (parameters.adaptive_iterations == 0) return 1.0f;
    if (!converged || iterations > parameters.adaptive_iterations) return fmin(2.0f * factor, 1024.0f);
    return 2 * iterations <= parameters.adaptive_iterations ? fmax(0.5f * factor, 1.0f) : factor;
}

#endif
