// SPDX-License-Identifier: MIT
// Small steps begin: x = x̃ + Δt ṽ / walked (Macklin et al. 2019, docs/formulation.md). Reference: apsl::reference,
// strain_limiter. Moves 32 B read, 48 B written a vertex (strides of 3).
#include "layout.h"
#include "vertex_motion.h"
#include "work_group.h"

APSL_KERNEL void start_walk(__global const apsl_cloth* cloths, __global const apsl_parameters* parameters,
                            __global const apsl_solve_state* states, __global const uint* vertex_order,
                            __global float4* predicted, __global float4* motion, __global float4* correction,
                            __global const float* velocities, ulong velocity_offset) {
    const uint c = (uint)get_group_id(1);
    const int walked = walked_sub_steps(parameters[c]);
    start_walking(cloths[c], walked > 0 && !states[c].stopped, parameters[c].time_step, walked, vertex_order, predicted,
                  motion, correction, velocities + velocity_offset);
}
