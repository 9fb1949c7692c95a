// SPDX-License-Identifier: MIT
// The vector part of a CG iteration, all of it in one pass. Reference: apsl::reference::conjugate_gradient.
// Moves r, q, p, s, y, α D read, r, p, s, y written: 40 B a triangle.
#include "cg_step.h"
#include "layout.h"
#include "work_group.h"

// Stores a partial sum for the next iteration. A solve that has ended hands its last one on, so that both slots hold
// it.
APSLK_INLINE void store_or_hand_on(__global float* partials, uint even_kind, uint slot, bool iterating, float sum) {
    const uint groups = (uint)get_num_groups(0), group = (uint)get_group_id(0);
    const float last = partials_of(partials, even_kind + slot, groups)[group];
    partials_of(partials, even_kind + (slot ^ 1u), groups)[group] = iterating ? sum : last;
}

APSLK_KERNEL void cg_update(__global const apslk_cloth* cloths, __global apslk_solve_state* states,
                            __global float* partials, __global numbers* residual,
                            __global const numbers* scaled_diagonal, __global const numbers* product,
                            __global numbers* direction, __global numbers* direction_product,
                            __global numbers* pressure, int iteration) {
    APSLK_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const uint slot = (uint)iteration & 1u;
    const float curvature = sum_partials(partials, APSLK_PARTIAL_CURVATURE, (uint)get_num_groups(0), scratch);
    const float2 coefficients =
        cg_coefficients(states[c].scaled_residual[slot], curvature, states[c].scaled_residual[slot ^ 1u],
                        states[c].step[slot ^ 1u], iteration);
    const float step = coefficients.x, beta = coefficients.y;
    const bool iterating = states[c].iterating && step > 0.0f;
    const float2 sums = advance_cg(cloths[c], iterating, step, beta, iteration == 0, residual, scaled_diagonal, product,
                                   direction, direction_product, pressure);
    const float squares = group_sum(sums.x, scratch), scaled_squares = group_sum(sums.y, scratch);

    if (get_local_id(0) == 0) {
        store_or_hand_on(partials, APSLK_PARTIAL_RESIDUAL_EVEN, slot, iterating, squares);
        store_or_hand_on(partials, APSLK_PARTIAL_SCALED_RESIDUAL_EVEN, slot, iterating, scaled_squares);
        if (get_group_id(0) == 0 && states[c].iterating) states[c].step[slot] = step;
        if (get_group_id(0) == 0 && iterating) states[c].solve_iterations = iteration + 1;
    }
}
