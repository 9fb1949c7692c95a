// SPDX-License-Identifier: MIT
// A first guess for a solve: what the sub-step of the same number found in the call before, y₀, scaled by the t that
// brings it nearest to the solution in the norm of A. So scaled, no guess is worse than none, however old.
// Reference: apsl::reference::start_from_guess.
#ifndef APSLK_WARM_START_H
#define APSLK_WARM_START_H

#include "layout.h"
#include "work_group.h"

// Sub-steps of a call whose pressures are kept; later ones share the last place. 0: every solve starts from nothing.
#ifndef APSLK_WARM_START_SUB_STEPS
#define APSLK_WARM_START_SUB_STEPS 0
#endif

// Where filter_in_one_group keeps a sub-step's pressures: one array each, behind those at work. Copied, since a pointer
// that changes with the sub-step would be held in scalar registers through all of the solve.
APSLK_INLINE ulong kept_place(int sub_step, uint stride) {
    return (ulong)(1 + min(sub_step, APSLK_WARM_START_SUB_STEPS - 1)) * stride;
}

APSLK_INLINE void copy_pressures(apslk_cloth cloth, __global float* to, __global const float* from) {
    const apslk_range range = share_of(cloth.triangle_count, true);
    for (uint n = range.first; n < range.end; n += APSLK_WORK_GROUP_SIZE)
        to[cloth.triangle_begin + n] = from[cloth.triangle_begin + n];
}

// This work-item's part of r̄·y₀.
APSLK_INLINE float guess_dot(apslk_cloth cloth, bool active, __global const numbers* residual,
                             __global const numbers* pressure) {
    const uint begin = cloth.triangle_begin / APSLK_NUMBERS;
    const apslk_range range = share_of((cloth.triangle_count + APSLK_NUMBERS - 1u) / APSLK_NUMBERS, active);
    numbers sum = (numbers)(0.0f);
    for (uint n = range.first; n < range.end; n += APSLK_WORK_GROUP_SIZE)
        sum += residual[begin + n] * pressure[begin + n];
    return sum_of_numbers(sum);
}

// t = r̄·y₀ / y₀·Ay₀; 0, which drops the guess, where that is no number.
APSLK_INLINE float guess_scale(float dot, float curvature) {
    const float scale = dot / curvature;
    return curvature > 0.0f && isfinite(scale) ? scale : 0.0f;
}

// y = t y₀, r = b − t A y₀ with A y₀ in `product`; this work-item's part of ‖r‖² and of r̄·r̄.
APSLK_INLINE float2 scale_guess(apslk_cloth cloth, bool active, float scale, __global numbers* residual,
                                __global const numbers* scaled_diagonal, __global const numbers* product,
                                __global numbers* pressure) {
    const uint begin = cloth.triangle_begin / APSLK_NUMBERS;
    const apslk_range range = share_of((cloth.triangle_count + APSLK_NUMBERS - 1u) / APSLK_NUMBERS, active);
    numbers squares = (numbers)(0.0f), scaled_squares = (numbers)(0.0f);
    for (uint n = range.first; n < range.end; n += APSLK_WORK_GROUP_SIZE) {
        const uint i = begin + n;
        numbers r = residual[i], y = (numbers)(0.0f);
        if (scale != 0.0f) {  // uniform; a dropped guess and its product may be anything
            y = scale * pressure[i];
            r -= scale * product[i];
            residual[i] = r;
        }
        pressure[i] = y;
        squares += r * r * scaled_diagonal[i];
        scaled_squares += r * r;
    }
    return (float2)(sum_of_numbers(squares), sum_of_numbers(scaled_squares));
}

#endif
