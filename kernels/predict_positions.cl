// SPDX-License-Identifier: MIT
// Algorithm 1, line 1: x ← x̃ + Δt ṽ, outside of contacts. Also begins the call: clears each cloth's state and
// statistics. Reference: apsl::reference, strain_limiter. Moves 32 B read, 16 B written a vertex (strides of 3), before
// small steps 16 B more written, with contacts 32 B more read, with accelerations 12 B more read and 16 B written.
#include "layout.h"
#include "vertex_motion.h"
#include "work_group.h"

APSLK_KERNEL void predict_positions(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                                    __global apslk_solve_state* states, __global apslk_stats* stats,
                                    __global float* partials, __global const uint* vertex_order, __global float4* moved,
                                    __global float4* motion, __global const float* positions, ulong position_offset,
                                    __global const float* velocities, ulong velocity_offset,
                                    __global const float* inverse_masses, ulong inverse_mass_offset,
                                    __global const float* contacts, ulong contact_offset
#if APSLK_ACCELERATION_PER_VERTEX
                                    ,
                                    __global float4* accelerations, __global const float* caller_accelerations,
                                    ulong acceleration_offset
#endif
) {
    APSLK_SCRATCH;
    const uint c = (uint)get_group_id(1);
#if APSLK_ACCELERATION_PER_VERTEX
    // A work-item reads below what it has written here.
    order_accelerations(cloths[c], parameters[c].enabled, vertex_order, accelerations,
                        caller_accelerations + acceleration_offset);
#endif
    const apslk_vertex_sums sums = predict_vertices(
        cloths[c], parameters[c].enabled, parameters[c].time_step, free_step(parameters + c, APSLK_ACCELERATIONS),
        small_step_count(parameters[c]) > 0, vertex_order, moved, motion, positions + position_offset,
        velocities + velocity_offset, inverse_masses + inverse_mass_offset, contacts + contact_offset);
    store_partial(partials, APSLK_PARTIAL_BAD_VERTICES, group_sum(sums.bad, scratch));
    store_partial(partials, APSLK_PARTIAL_LOG_MASSES, group_sum(sums.log_masses, scratch));
    store_partial(partials, APSLK_PARTIAL_MOVABLE, group_sum(sums.movable, scratch));
    store_partial(partials, APSLK_PARTIAL_EXTENT, group_max(sums.extent, scratch));
#if APSLK_INTEGRATES
    store_drive_partials(sums.drive, partials, scratch);
    store_partial(partials, APSLK_PARTIAL_BENDING_ENERGY, 0.0f);  // until bend_hinges finds any
    store_partial(partials, APSLK_PARTIAL_BENDING_LEFT, 0.0f);
#endif
    if (get_group_id(0) == 0 && get_local_id(0) == 0) {
        states[c].stopped = !parameters[c].enabled;
        states[c].discarded = 0;
        states[c].iterating = 0;
        states[c].initial_squared_residual = 0.0f;
        apslk_stats none = {0};
        none.status = parameters[c].enabled ? APSLK_STATUS_OK : APSLK_STATUS_OFF;
        none.offender = APSLK_OFFENDER_NONE;
        stats[c] = none;
    }
}
