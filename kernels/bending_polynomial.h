// SPDX-License-Identifier: MIT
// The polynomial in the bending stiffness that keeps a small step stable. Reference: apsl::reference,
// BendingPolynomial.
#ifndef APSLK_BENDING_POLYNOMIAL_H
#define APSLK_BENDING_POLYNOMIAL_H

#include "layout.h"

typedef struct {
    float scale;     // of the residual that it starts with
    float momentum;  // of step k ≥ 1
    float gain;      // likewise; of step 0 what it takes of the residual
    float reach;     // the greatest h² W K
} apslk_bending_step;

// With T_k at zero cosh(k η), η = arcosh(ripple) / degree.
APSLK_INLINE apslk_bending_step bending_step(int degree, int k) {
    const float whole = acosh(APSLK_BENDING_RIPPLE), eta = whole / (float)degree;
    apslk_bending_step step;
    step.scale = APSLK_BENDING_GREATEST / (1.0f + 1.0f / APSLK_BENDING_RIPPLE);
    const float slope = APSLK_BENDING_RIPPLE * sinh(eta) / (step.scale * (float)degree * sinh(whole));
    const float sigma = cosh(eta), ahead = cosh((float)(k + 1) * eta);
    step.reach = (sigma + 1.0f) / slope;
    step.momentum = k > 0 ? cosh((float)(k - 1) * eta) / ahead : 0.0f;
    step.gain = k > 0 ? 2.0f * slope * cosh((float)k * eta) / ahead : slope / sigma;
    return step;
}

#endif
