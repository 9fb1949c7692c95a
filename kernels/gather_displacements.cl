// SPDX-License-Identifier: MIT
// Eq. (6) with λ = p Δt²: x_i −= w_i Σ_{a∋i} λ_a g_{a,i}, and the residual the solve ended with.
// Reference: apsl::reference::displacements.
// Moves 12 B corners, 2 B offsets, 32 B gradients, 4 B pressure, 16 B position read and written, a triangle.
#include "gradients.h"
#include "layout.h"
#include "vertex_gather.h"
#include "work_group.h"

APSL_KERNEL void gather_displacements(__global const apsl_cloth* cloths, __global const apsl_parameters* parameters,
                                      __global const apsl_solve_state* states, __global apsl_stats* stats,
                                      __global float* partials, __global const uint* corner_offsets,
                                      __global const uint* corners, __global const apsl_gradients* gradients,
                                      __global const float* pressure, __global float4* predicted, uint slot) {
    APSL_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const apsl_cloth cloth = cloths[c];
    const float initial = states[c].initial_residual;
    // A right-hand side of zero does no iteration, and then there is no pressure to read.
    const apsl_range range = share_of(cloth.vertex_count, !states[c].stopped && states[c].has_pressure);
    for (uint v = range.first; v < range.end; v += APSL_WORK_GROUP_SIZE) {
        const uint i = cloth.vertex_begin + v;
        const float4 x = predicted[i];
        if (x.w > 0.0f) predicted[i] = x - x.w * sum_over_corners(corner_offsets, corners, gradients, pressure, i);
    }
    const float residual = sum_partials(partials, APSL_PARTIAL_RESIDUAL_EVEN + slot, (uint)get_num_groups(0), scratch);
    if (get_group_id(0) == 0 && get_local_id(0) == 0 && !states[c].stopped && initial > 0.0f) {
        stats[c].residual = fmax(stats[c].residual, sqrt(residual / initial));
        if (residual > parameters[c].tolerance_squared * initial && stats[c].status == APSL_STATUS_OK)
            stats[c].status = APSL_STATUS_NOT_CONVERGED;
    }
}
