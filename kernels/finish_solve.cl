// SPDX-License-Identifier: MIT
// Finishes solves that did not converge in the queued iterations, one work-group a cloth. Usually it does nothing: it
// replaces many launches that would have had nothing to do. Reference: apsl::reference::conjugate_gradient.
#include "layout.h"
#include "patch_product.h"
#include "solve_in_one_group.h"
#include "work_group.h"

// `iterations`, even, have been queued before, by launches of `groups` work-groups.
APSLK_KERNEL void finish_solve(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                               __global apslk_solve_state* states, __global float* partials,
                               __global const uint2* patches, __global const uint* patch_vertices,
                               __global const ushort* local_triangles, __global const uint* corner_offsets,
                               __global const uint* corners, __global const apslk_gradients* gradients,
                               __global float* residual, __global const float* scaled_diagonal, __global float* product,
                               __global float* direction, __global float* direction_product, __global float* pressure,
                               uint groups, int iterations) {
    APSLK_SCRATCH;
    __local float4 forces[APSLK_PATCH_VERTICES];
    const uint c = (uint)get_group_id(1);
    // A solve that stopped early, for whatever reason, is not taken up again.
    const bool unfinished = !states[c].stopped && states[c].solve_iterations == iterations;
    apslk_solve solve;
    solve.iterations = states[c].solve_iterations;
    solve.initial_squared_residual = states[c].initial_squared_residual;
    solve.residual = sum_partials(partials, APSLK_PARTIAL_RESIDUAL_EVEN, groups, scratch);
    solve.scaled_residual = sum_partials(partials, APSLK_PARTIAL_SCALED_RESIDUAL_EVEN, groups, scratch);
    solve.previous_scaled_residual = states[c].scaled_residual[1];
    solve.previous_step = states[c].step[1];
    group_memory_barrier();  // all have read the state
    if (unfinished) {        // uniform: the same for all work-items of the group
        iterate_in_group(&solve, false, parameters + c, cloths + c, patches, patch_vertices, local_triangles,
                         corner_offsets, corners, gradients, residual, scaled_diagonal, product, direction,
                         direction_product, pressure, forces, scratch);
        for (uint g = (uint)get_local_id(0); g < groups; g += APSLK_WORK_GROUP_SIZE)
            partials_of(partials, APSLK_PARTIAL_RESIDUAL_EVEN, groups)[g] = g == 0 ? solve.residual : 0.0f;
        if (get_local_id(0) == 0) states[c].solve_iterations = solve.iterations;
    }
}
