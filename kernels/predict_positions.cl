// SPDX-License-Identifier: MIT
// Algorithm 1, line 1: x ← x̃ + Δt ṽ. Reference: apsl::reference::predict_positions.
// Moves 28 B read, 16 B written a vertex (strides of 3).
#include "layout.h"
#include "work_group.h"

#ifndef APSL_POSITION_STRIDE
#define APSL_POSITION_STRIDE 3
#endif
#ifndef APSL_VELOCITY_STRIDE
#define APSL_VELOCITY_STRIDE 3
#endif

// Explicitly fused, so that update_velocities finds the same bits again whatever the compiler contracts.
static inline __attribute__((always_inline)) float4 predicted_position(float4 position, float4 velocity,
                                                                       float time_step) {
    return fma((float4)(time_step), velocity, position);
}

static inline __attribute__((always_inline)) float4 load_position(__global const float* positions, uint vertex) {
    return (float4)(vload3(0, positions + (ulong)vertex * APSL_POSITION_STRIDE), 0.0f);
}

static inline __attribute__((always_inline)) float4 load_velocity(__global const float* velocities, uint vertex) {
    return (float4)(vload3(0, velocities + (ulong)vertex * APSL_VELOCITY_STRIDE), 0.0f);
}

// predicted[i] = (x, inverse mass). Also begins the call: the first group clears the cloth's state and statistics.
APSL_KERNEL void predict_positions(__global const apsl_cloth* cloths, __global const apsl_parameters* parameters,
                                   __global apsl_solve_state* states, __global apsl_stats* stats,
                                   __global float4* predicted, __global const float* positions, ulong position_offset,
                                   __global const float* velocities, ulong velocity_offset,
                                   __global const float* inverse_masses, ulong inverse_mass_offset) {
    const uint c = (uint)get_group_id(1);
    const apsl_cloth cloth = cloths[c];
    const float time_step = parameters[c].time_step;
    const apsl_range range = share_of(cloth.vertex_count, true);
    for (uint v = range.first; v < range.end; v += APSL_WORK_GROUP_SIZE) {
        const uint i = cloth.vertex_begin + v;
        float4 x = predicted_position(load_position(positions + position_offset, i),
                                      load_velocity(velocities + velocity_offset, i), time_step);
        x.w = inverse_masses[inverse_mass_offset + i];
        predicted[i] = x;
    }
    if (get_group_id(0) == 0 && get_local_id(0) == 0) {
        states[c].stopped = 0;
        states[c].iterating = 0;
        states[c].initial_residual = 0.0f;
        stats[c].sub_steps = 0;
        stats[c].cg_iterations = 0;
        stats[c].residual = 0.0f;
        stats[c].max_area_change = 0.0f;
        stats[c].rms_area_change = 0.0f;
        stats[c].status = APSL_STATUS_OK;
    }
}
