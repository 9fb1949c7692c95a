// SPDX-License-Identifier: MIT
// Small steps begin: x = x̃ + Δt ṽ / small_steps (Macklin et al. 2019, docs/formulation.md). Reference: apsl::reference,
// strain_limiter. Moves 32 B read, 48 B written a vertex (strides of 3), with accelerations 16 B
// more read, with tethers 8 B a tether and what its anchor takes.
#include "layout.h"
#include "vertex_motion.h"
#include "work_group.h"

APSLK_KERNEL void start_small_steps(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                                    __global const apslk_solve_state* states, __global const uint* vertex_order,
                                    __global float4* moved, __global float4* motion, __global float4* total_correction,
                                    __global const float* velocities,
                                    ulong velocity_offset APSLK_ACCELERATIONS_ARGUMENT APSLK_TETHERS_ARGUMENT) {
    const uint c = (uint)get_group_id(1);
    const int small_steps = small_step_count(parameters[c]);
    const apslk_tethers tethers = APSLK_TETHERS_GIVEN;
    begin_small_steps(cloths[c], small_steps > 0 && !states[c].stopped, parameters[c].time_step,
                      free_part(parameters + c, APSLK_ACCELERATIONS), small_steps, vertex_order, moved, motion,
                      total_correction, velocities + velocity_offset, tethers);
}
