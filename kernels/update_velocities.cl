// SPDX-License-Identifier: MIT
// Algorithm 1, output: ṽ ← ṽ + (x − (x̃ + Δt ṽ)) / Δt. Only the corrections go in: with x the predicted position, the
// line as printed would count Δt ṽ twice. Reference: apsl::reference::update_velocities. Moves 16 B + 24 B read, 12 B
// written a vertex (strides of 3).
#include "layout.h"
#include "work_group.h"

#ifndef APSL_POSITION_STRIDE
#define APSL_POSITION_STRIDE 3
#endif
#ifndef APSL_VELOCITY_STRIDE
#define APSL_VELOCITY_STRIDE 3
#endif

APSL_KERNEL void update_velocities(__global const apsl_cloth* cloths, __global const apsl_parameters* parameters,
                                   __global const apsl_stats* stats, __global const float4* predicted,
                                   __global const float* positions, ulong position_offset, __global float* velocities,
                                   ulong velocity_offset) {
    const uint c = (uint)get_group_id(1);
    const apsl_cloth cloth = cloths[c];
    const float time_step = parameters[c].time_step;
    const float inverse_time_step = parameters[c].inverse_time_step;
    const apsl_range range = share_of(cloth.vertex_count, stats[c].status != APSL_STATUS_DIVERGED);
    for (uint v = range.first; v < range.end; v += APSL_WORK_GROUP_SIZE) {
        const uint i = cloth.vertex_begin + v;
        const float4 x = predicted[i];
        if (!(x.w > 0.0f)) continue;  // a pinned vertex keeps every bit of its velocity
        __global float* velocity = velocities + velocity_offset + (ulong)i * APSL_VELOCITY_STRIDE;
        const float3 before = vload3(0, velocity);
        const float3 start = vload3(0, positions + position_offset + (ulong)i * APSL_POSITION_STRIDE);
        // The same fused expression as predict_positions: a vertex nothing moved gets exactly zero.
        const float3 correction = x.xyz - fma((float3)(time_step), before, start);
        const float3 after = before + correction * inverse_time_step;
        // No triangle vouches for a vertex that is in none, nor for a velocity that overflows.
        if (all(isfinite(after))) vstore3(after, 0, velocity);
    }
}
