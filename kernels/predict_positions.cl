// SPDX-License-Identifier: MIT
// Algorithm 1, line 1: x ← x̃ + Δt ṽ. Also begins the call: clears each cloth's state and statistics.
// Reference: apsl::reference, strain_limiter.
// Moves 32 B read, 16 B written a vertex (strides of 3), before a walk 16 B more written.
#include "layout.h"
#include "vertex_motion.h"
#include "work_group.h"

APSL_KERNEL void predict_positions(__global const apsl_cloth* cloths, __global const apsl_parameters* parameters,
                                   __global apsl_solve_state* states, __global apsl_stats* stats,
                                   __global float* partials, __global const uint* vertex_order,
                                   __global float4* predicted, __global float4* motion, __global const float* positions,
                                   ulong position_offset, __global const float* velocities, ulong velocity_offset,
                                   __global const float* inverse_masses, ulong inverse_mass_offset) {
    APSL_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const apsl_vertex_sums sums =
        predict_vertices(cloths[c], parameters[c].enabled, parameters[c].time_step, walked_sub_steps(parameters[c]) > 0,
                         vertex_order, predicted, motion, positions + position_offset, velocities + velocity_offset,
                         inverse_masses + inverse_mass_offset);
    store_partial(partials, APSL_PARTIAL_BAD_VERTICES, group_sum(sums.bad, scratch));
    store_partial(partials, APSL_PARTIAL_LOG_MASSES, group_sum(sums.log_masses, scratch));
    store_partial(partials, APSL_PARTIAL_MOVABLE, group_sum(sums.movable, scratch));
    store_partial(partials, APSL_PARTIAL_EXTENT, group_max(sums.extent, scratch));
    if (get_group_id(0) == 0 && get_local_id(0) == 0) {
        states[c].stopped = !parameters[c].enabled;
        states[c].discarded = 0;
        states[c].iterating = 0;
        states[c].initial_residual = 0.0f;
        const int status = parameters[c].enabled ? APSL_STATUS_OK : APSL_STATUS_OFF;
        stats[c] = (apsl_stats){0, 0, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, status, APSL_OFFENDER_NONE, 0, 0, 0.0f};
    }
}
