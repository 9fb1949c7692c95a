// SPDX-License-Identifier: MIT
// The vector part of a CG iteration (Chronopoulos and Gear 1989). Reference: apsl::reference::conjugate_gradient.
#ifndef APSLK_CG_STEP_H
#define APSLK_CG_STEP_H

#include "layout.h"
#include "warm_start.h"
#include "work_group.h"

// Chronopoulos and Gear: β = γ_k / γ_{k−1}, α = γ_k / (δ_k − β γ_k / α_{k−1}). Step 0 where the matrix shows no
// curvature above rounding along the direction (α = 1 can bring that about): the solve then stays where it is, for
// good, since a former step of 0 makes the denominator −∞.
APSLK_INLINE float2 cg_coefficients(float residual, float curvature, float previous_residual, float previous_step,
                                    int iteration) {
    const float beta = iteration == 0 ? 0.0f : residual / previous_residual;
    const float denominator = iteration == 0 ? curvature : curvature - beta * residual / previous_step;
    const float step = residual / denominator;
    const bool usable = denominator > FLT_EPSILON * residual && isfinite(step) && isfinite(beta);
    return usable ? (float2)(step, beta) : (float2)(0.0f, 0.0f);
}

// p = r + βp, s = q + βs, y += αp, r −= αs; this work-item's part of ‖r‖² and of r̄·r̄.
APSLK_INLINE float2 advance_cg(apslk_cloth cloth, bool active, float step, float beta, bool first_iteration,
                               __global numbers* residual, __global const numbers* scaled_diagonal,
                               __global const numbers* product, __global numbers* direction,
                               __global numbers* direction_product, __global numbers* pressure) {
    const uint begin = cloth.triangle_begin / APSLK_NUMBERS;
    const apslk_range range = share_of((cloth.triangle_count + APSLK_NUMBERS - 1u) / APSLK_NUMBERS, active);
    numbers squares = (numbers)(0.0f), scaled_squares = (numbers)(0.0f);
    for (uint n = range.first; n < range.end; n += APSLK_WORK_GROUP_SIZE) {
        const uint i = begin + n;
        const numbers q = product[i];
        numbers r = residual[i], p = r, s = q, y = (numbers)(0.0f);
        if (!first_iteration) {  // uniform; what a former solve left behind is never read
            p += beta * direction[i];
            s += beta * direction_product[i];
        }
        if (APSLK_WARM_START_SUB_STEPS > 0 || !first_iteration) y = pressure[i];
        y += step * p;
        r -= step * s;
        direction[i] = p;
        direction_product[i] = s;
        pressure[i] = y;
        residual[i] = r;
        squares += r * r * scaled_diagonal[i];
        scaled_squares += r * r;
    }
    return (float2)(sum_of_numbers(squares), sum_of_numbers(scaled_squares));
}

#endif
