// SPDX-License-Identifier: MIT
// The polynomial that takes the place of a solve: its degree and its coefficients.
// Reference: chebyshev_products and apsl::reference::chebyshev.
#ifndef APSLK_CHEBYSHEV_H
#define APSLK_CHEBYSHEV_H

#include "layout.h"
#include "limits_stretch.h"
#include "regularization.h"

// Products with the matrix that have the reach of the sub-step's α.
APSLK_INLINE int chebyshev_products(apslk_parameters parameters, int sub_step) {
    const float damping = (parameters.regularization - 1.0f) *
                          scheduled_damping(parameters.damping_step, parameters.sub_steps - 1 - sub_step);
    const float reach = APSLK_LIMITS_STRETCH ? APSLK_ROWS_REACH : APSLK_CHEBYSHEV_REACH;
    return (int)clamp(round(sqrt(reach / damping)) - 1.0f, 1.0f, (float)parameters.max_iterations);
}

typedef struct {
    float first;     // 1/θ: y₁ over the right-hand side
    float momentum;  // a_k
    float gain;      // b_k
} apslk_chebyshev_step;

// Of the step from y_k to y_{k+1}, k from 1 on: a_k = T_{k−1}(σ)/T_{k+1}(σ), b_k = 2 T_k(σ)/T_{k+1}(σ)/δ, where
// T_degree(σ) = 3, T_k(σ) = cosh(k η), and the polynomial swings between ±1/3 from θ − δ to θ + δ = 1.
APSLK_INLINE apslk_chebyshev_step chebyshev_coefficients(int degree, int k) {
    const float eta = 1.7627472f / (float)degree;  // arcosh 3
    const float root = tanh(0.5f * eta);
    const float low = root * root;  // (σ − 1)/(σ + 1)
    const float ahead = cosh((float)(k + 1) * eta);
    apslk_chebyshev_step step;
    step.first = 2.0f / (1.0f + low);
    step.momentum = cosh((float)(k - 1) * eta) / ahead;
    step.gain = 4.0f * cosh((float)k * eta) / (ahead * (1.0f - low));
    return step;
}

#endif
