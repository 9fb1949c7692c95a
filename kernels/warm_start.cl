// SPDX-License-Identifier: MIT
// Before the iterations of a solve with a warm start: measure_guess, a *_dot launch that multiplies the guess, and
// start_from_guess. Reference: apsl::reference::start_from_guess.
#include "layout.h"
#include "warm_start.h"
#include "work_group.h"

// Moves 8 B a triangle.
APSLK_KERNEL void measure_guess(__global const apslk_cloth* cloths, __global const apslk_solve_state* states,
                                __global float* partials, __global const numbers* residual,
                                __global const numbers* pressure) {
    APSLK_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const float dot = guess_dot(cloths[c], !states[c].stopped, residual, pressure);
    store_partial(partials, APSLK_PARTIAL_GUESS, group_sum(dot, scratch));
}

// Moves r, y, α D, A y read, r, y written: 24 B a triangle.
APSLK_KERNEL void start_from_guess(__global const apslk_cloth* cloths, __global const apslk_solve_state* states,
                                   __global float* partials, __global numbers* residual,
                                   __global const numbers* scaled_diagonal, __global const numbers* product,
                                   __global numbers* pressure) {
    APSLK_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const uint groups = (uint)get_num_groups(0);
    const float dot = sum_partials(partials, APSLK_PARTIAL_GUESS, groups, scratch);
    const float scale = guess_scale(dot, sum_partials(partials, APSLK_PARTIAL_CURVATURE, groups, scratch));
    const float2 sums = scale_guess(cloths[c], !states[c].stopped, scale, residual, scaled_diagonal, product, pressure);
    store_partial(partials, APSLK_PARTIAL_RESIDUAL_EVEN, group_sum(sums.x, scratch));
    store_partial(partials, APSLK_PARTIAL_SCALED_RESIDUAL_EVEN, group_sum(sums.y, scratch));
}
