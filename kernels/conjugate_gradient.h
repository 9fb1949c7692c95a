// SPDX-License-Identifier: MIT
// Conjugate Gradient with one reduction point an iteration (Chronopoulos and Gear 1989), stopped on the device.
//
// Iteration k, in the scaled unknowns of gradients.h, is two launches:
//   *_apply_dot / *_spmv_dot   q = A r, partial sums of r·q
//   cg_update                  p = r + βp, s = q + βs, y += αp, r −= αs, partial sums of r·r
// The first of them decides for all whether the iteration is done (begin_iteration). It decides by ‖r‖ in m², not by
// the scaled r̄·r̄ that CG itself minimises over: the scaled one weighs a triangle beside a pin too little to see it.
#ifndef APSLK_CONJUGATE_GRADIENT_H
#define APSLK_CONJUGATE_GRADIENT_H

#include "layout.h"
#include "work_group.h"

// True where iteration k has work to do: every group finds it out from the same partial sums, and the first group
// publishes it, with γ_k, for the launches that follow.
APSLK_INLINE bool begin_iteration(__global const apslk_parameters* parameters, __global apslk_solve_state* states,
                                  __global float* partials, int iteration, __local float* scratch) {
    const uint c = (uint)get_group_id(1);
    const uint slot = (uint)iteration & 1u;
    const uint groups = (uint)get_num_groups(0);
    const float residual = sum_partials(partials, APSLK_PARTIAL_RESIDUAL_EVEN + slot, groups, scratch);
    const float scaled_residual = sum_partials(partials, APSLK_PARTIAL_SCALED_RESIDUAL_EVEN + slot, groups, scratch);
    const bool iterating = !states[c].stopped && iteration < parameters[c].max_iterations &&
                           residual > parameters[c].tolerance_squared * states[c].initial_squared_residual;
    if (get_group_id(0) == 0 && get_local_id(0) == 0) {
        states[c].iterating = iterating ? 1 : 0;
        states[c].scaled_residual[slot] = scaled_residual;
    }
    return iterating;
}

#endif
