// SPDX-License-Identifier: MIT
// The output of a call that is a whole time step: where the last small step ended, and its velocity; where nothing was
// limited, or the limit left the cloth worse, the step of acceleration and damping alone. Reference: apsl::reference,
// strain_limiter. Moves 60 B read, 24 B written a vertex (strides of 3), with contacts 32 B more read, with
// accelerations 16 B.
#include "layout.h"
#include "vertex_motion.h"
#include "work_group.h"

APSLK_KERNEL void store_step(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                             __global const apslk_solve_state* states, __global const apslk_stats* stats,
                             __global const uint* vertex_order, __global const float4* moved,
                             __global const float4* motion, __global float* positions, ulong position_offset,
                             __global float* velocities, ulong velocity_offset, __global const float* contacts,
                             ulong contact_offset APSLK_ACCELERATIONS_ARGUMENT) {
    const uint c = (uint)get_group_id(1);
    const bool active = parameters[c].enabled && stats[c].status != APSLK_STATUS_DIVERGED;
    const apslk_kept_shares kept = {states[c].speed_kept, states[c].gain_kept};
    store_end_of_step(cloths[c], active, !states[c].discarded, vload3(0, states[c].drive), kept,
                      parameters[c].time_step, free_step(parameters + c, APSLK_ACCELERATIONS), vertex_order, moved,
                      motion, positions + position_offset, velocities + velocity_offset, contacts + contact_offset);
}
