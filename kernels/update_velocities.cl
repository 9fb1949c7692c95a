// SPDX-License-Identifier: MIT
// Algorithm 1, output: ṽ ← ṽ + (x − (x̃ + Δt ṽ)) / Δt. Only the corrections go in: with x the moved position, the
// line as printed would count Δt ṽ twice. Reference: apsl::reference, strain_limiter. Moves 20 B + 24 B read, 12 B
// written a vertex (strides of 3); after small steps 16 B more read.
// With contacts a call that was thrown away still keeps x̃ + Δt ṽ outside of them.
// With APSLK_POSITIONS_ONLY the corrected positions instead: `velocities` is then the caller's positions.
#include "layout.h"
#include "vertex_motion.h"
#include "work_group.h"

APSLK_KERNEL void update_velocities(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                                    __global const apslk_solve_state* states, __global const apslk_stats* stats,
                                    __global const uint* vertex_order, __global const float4* moved,
                                    __global const float4* total_correction, __global const float* positions,
                                    ulong position_offset, __global float* velocities, ulong velocity_offset,
                                    __global const float* contacts, ulong contact_offset) {
    const uint c = (uint)get_group_id(1);
    const bool limited = !states[c].discarded;
    const bool keeps = APSLK_KEEPS_CONTACTS && parameters[c].enabled && stats[c].status != APSLK_STATUS_DIVERGED;
    store_corrections(cloths[c], limited || keeps, limited, parameters[c].time_step,
                      small_step_count(parameters[c]) > 0, vertex_order, moved, total_correction,
                      positions + position_offset, velocities + velocity_offset, contacts + contact_offset);
}
