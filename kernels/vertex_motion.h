// SPDX-License-Identifier: MIT
// How vertices move: Algorithm 1, line 1 (predict), line 6 with Eq. (6) (displace) and its output (velocities).
// Reference: apsl::reference, strain_limiter and displacements.
#ifndef APSL_VERTEX_MOTION_H
#define APSL_VERTEX_MOTION_H

#include "gradients.h"
#include "layout.h"
#include "vertex_gather.h"
#include "work_group.h"

#ifndef APSL_POSITION_STRIDE
#define APSL_POSITION_STRIDE 3
#endif
#ifndef APSL_VELOCITY_STRIDE
#define APSL_VELOCITY_STRIDE 3
#endif

// Explicitly fused, so that predicting twice gives the same bits whatever the compiler contracts.
APSL_INLINE float3 predicted_position(float3 position, float3 velocity, float time_step) {
    return fma((float3)(time_step), velocity, position);
}

APSL_INLINE float3 load_position(__global const float* positions, uint vertex) {
    return vload3(0, positions + (ulong)vertex * APSL_POSITION_STRIDE);
}

APSL_INLINE float3 load_velocity(__global const float* velocities, uint vertex) {
    return vload3(0, velocities + (ulong)vertex * APSL_VELOCITY_STRIDE);
}

// predicted = (x̃ + Δt ṽ, inverse mass), in the limiter's order of vertices.
APSL_INLINE void predict_vertices(apsl_cloth cloth, float time_step, __global const uint* vertex_order,
                                  __global float4* predicted, __global const float* positions,
                                  __global const float* velocities, __global const float* inverse_masses) {
    const apsl_range range = share_of(cloth.vertex_count, true);
    for (uint v = range.first; v < range.end; v += APSL_WORK_GROUP_SIZE) {
        const uint i = vertex_order[cloth.vertex_begin + v];
        predicted[cloth.vertex_begin + v] =
            (float4)(predicted_position(load_position(positions, i), load_velocity(velocities, i), time_step),
                     inverse_masses[i]);
    }
}

// x_i −= w_i Σ_{a∋i} λ_a g_{a,i}, in scaled terms √(2 w_i) Σ y_a ḡ_{a,i}.
APSL_INLINE void displace_vertices(apsl_cloth cloth, bool active, __global const uint* corner_offsets,
                                   __global const uint* corners, __global const apsl_gradients* gradients,
                                   __global const float* pressure, __global float4* predicted) {
    const apsl_range range = share_of(cloth.vertex_count, active);
    for (uint v = range.first; v < range.end; v += APSL_WORK_GROUP_SIZE) {
        const uint i = cloth.vertex_begin + v;
        const float4 x = predicted[i];
        if (x.w > 0.0f)
            predicted[i] = x - sqrt(2.0f * x.w) * sum_over_corners(corner_offsets, corners, gradients, pressure, i);
    }
}

// ṽ += (x − (x̃ + Δt ṽ)) / Δt.
APSL_INLINE void correct_velocities(apsl_cloth cloth, bool active, apsl_parameters parameters,
                                    __global const uint* vertex_order, __global const float4* predicted,
                                    __global const float* positions, __global float* velocities) {
    const apsl_range range = share_of(cloth.vertex_count, active);
    for (uint v = range.first; v < range.end; v += APSL_WORK_GROUP_SIZE) {
        const uint i = vertex_order[cloth.vertex_begin + v];
        const float4 x = predicted[cloth.vertex_begin + v];
        if (!(x.w > 0.0f)) continue;  // a pinned vertex keeps every bit of its velocity
        const float3 before = load_velocity(velocities, i);
        // A vertex nothing moved gets exactly zero.
        const float3 correction = x.xyz - predicted_position(load_position(positions, i), before, parameters.time_step);
        const float3 after = before + correction * (1.0f / parameters.time_step);
        // No triangle vouches for a vertex that is in none, nor for a velocity that overflows.
        if (all(isfinite(after))) vstore3(after, 0, velocities + (ulong)i * APSL_VELOCITY_STRIDE);
    }
}

#endif
