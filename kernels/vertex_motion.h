// SPDX-License-Identifier: MIT
// How vertices move: Algorithm 1, line 1 (predict), line 6 with Eq. (6) (displace) and its output (velocities); and
// with small steps the way there. Reference: apsl::reference, strain_limiter and displacements.
#ifndef APSL_VERTEX_MOTION_H
#define APSL_VERTEX_MOTION_H

#include "effective_mass.h"
#include "gradients.h"
#include "layout.h"
#include "small_steps.h"
#include "vertex_gather.h"
#include "work_group.h"

#ifndef APSL_POSITION_STRIDE
#define APSL_POSITION_STRIDE 3
#endif
#ifndef APSL_VELOCITY_STRIDE
#define APSL_VELOCITY_STRIDE 3
#endif
// From x to y to z: 1 where they lie side by side.
#ifndef APSL_POSITION_COMPONENT_STRIDE
#define APSL_POSITION_COMPONENT_STRIDE 1
#endif
#ifndef APSL_VELOCITY_COMPONENT_STRIDE
#define APSL_VELOCITY_COMPONENT_STRIDE 1
#endif
#ifndef APSL_INVERSE_MASS_STRIDE
#define APSL_INVERSE_MASS_STRIDE 1
#endif

APSL_INLINE float3 load_vector(__global const float* x, ulong component_stride) {
    return component_stride == 1 ? vload3(0, x) : (float3)(x[0], x[component_stride], x[2 * component_stride]);
}

APSL_INLINE void store_vector(float3 v, __global float* x, ulong component_stride) {
    if (component_stride == 1) {
        vstore3(v, 0, x);
    } else {
        x[0] = v.x;
        x[component_stride] = v.y;
        x[2 * component_stride] = v.z;
    }
}

// Explicitly fused, so that predicting twice gives the same bits whatever the compiler contracts.
APSL_INLINE float3 predicted_position(float3 position, float3 velocity, float time_step) {
    return fma((float3)(time_step), velocity, position);
}

APSL_INLINE float3 load_position(__global const float* positions, uint vertex) {
    return load_vector(positions + (ulong)vertex * APSL_POSITION_STRIDE, APSL_POSITION_COMPONENT_STRIDE);
}

APSL_INLINE float3 load_velocity(__global const float* velocities, uint vertex) {
    return load_vector(velocities + (ulong)vertex * APSL_VELOCITY_STRIDE, APSL_VELOCITY_COMPONENT_STRIDE);
}

// x̃ + Δt ṽ of the caller's vertex. Where there are no velocities, `velocities` is the positions, in and out, and this
// the position as given, to the bit: one pointer in place of two, which the large kernel has no registers for.
APSL_INLINE float3 end_of_step(__global const float* positions, __global const float* velocities, uint vertex,
                               float time_step) {
#if APSL_POSITIONS_ONLY
    (void)positions;
    (void)time_step;
    return load_position(velocities, vertex);
#else
    return predicted_position(load_position(positions, vertex), load_velocity(velocities, vertex), time_step);
#endif
}

// Of (x̃ + Δt ṽ, inverse mass). A position or velocity that is not finite leaves nothing finite.
APSL_INLINE bool is_bad_vertex(float4 predicted) {
    return !isfinite(predicted.x) || !isfinite(predicted.y) || !isfinite(predicted.z) || !isfinite(predicted.w) ||
           predicted.w < 0.0f;
}

typedef struct {
    float bad;         // vertices
    float log_masses;  // Σ log₂ m of movable vertices
    float movable;     // vertices
    float extent;      // greatest |coordinate|, m
} apsl_vertex_sums;

// predicted = (x̃ + Δt ṽ, w), and before a walk motion = (x̃, w), in the limiter's order of vertices. Returns this
// work-item's sums.
APSL_INLINE apsl_vertex_sums predict_vertices(apsl_cloth cloth, bool active, float time_step, bool walking,
                                              __global const uint* vertex_order, __global float4* predicted,
                                              __global float4* motion, __global const float* positions,
                                              __global const float* velocities, __global const float* inverse_masses) {
    const apsl_range range = share_of(cloth.vertex_count, active);
    apsl_vertex_sums sums = {0.0f, 0.0f, 0.0f, 0.0f};
    for (uint v = range.first; v < range.end; v += APSL_WORK_GROUP_SIZE) {
        const uint place = cloth.vertex_begin + v, i = vertex_order[place];
        const float w = inverse_masses[(ulong)i * APSL_INVERSE_MASS_STRIDE];
        const float4 x = (float4)(end_of_step(positions, velocities, i, time_step), w);
        predicted[place] = x;
        if (walking) motion[place] = (float4)(load_position(positions, i), w);
        sums.bad += is_bad_vertex(x) ? 1.0f : 0.0f;
        sums.log_masses += w > 0.0f ? -log2(w) : 0.0f;
        sums.movable += w > 0.0f ? 1.0f : 0.0f;
        sums.extent = fmax(sums.extent, fmax(fabs(x.x), fmax(fabs(x.y), fabs(x.z))));
    }
    return sums;
}

// The first of `walked` parts of the step: predicted = x̃ + Δt ṽ / walked, motion = (Δt ṽ, w), correction = 0. The w of
// `correction` is the kept stiffness K, 0 where it never was too much.
APSL_INLINE void start_walking(apsl_cloth cloth, bool active, float time_step, int walked,
                               __global const uint* vertex_order, __global float4* predicted, __global float4* motion,
                               __global float4* correction, __global const float* velocities) {
    const apsl_range range = share_of(cloth.vertex_count, active);
    const float part = 1.0f / (float)walked;
    for (uint v = range.first; v < range.end; v += APSL_WORK_GROUP_SIZE) {
        const uint place = cloth.vertex_begin + v;
        const float3 step = time_step * load_velocity(velocities, vertex_order[place]);
        const float4 start = motion[place];
        predicted[place] = (float4)(fma((float3)(part), step, start.xyz), start.w);
        motion[place] = (float4)(step, start.w);
        correction[place] = (float4)(0.0f);
    }
}

// x_i += Δx_i = −w_i Σ_{a∋i} λ_a g_{a,i}, in scaled terms −√(2 w_i) Σ y_a ḡ_{a,i}; its w is zero.
APSL_INLINE void displace_vertices(apsl_cloth cloth, bool active, __global const uint* corner_offsets,
                                   __global const uint* corners, __global const apsl_gradients* gradients,
                                   __global const float* pressure, __global float4* predicted) {
    const apsl_range range = share_of(cloth.vertex_count, active);
    for (uint v = range.first; v < range.end; v += APSL_WORK_GROUP_SIZE) {
        const uint i = cloth.vertex_begin + v;
        const float4 x = predicted[i];
        // One expression, which the compiler may fuse.
        if (x.w > 0.0f)
            predicted[i] = x - sqrt(2.0f * x.w) * sum_over_corners(corner_offsets, corners, gradients, pressure, i);
    }
}

// A sub-step of a walk. The same for all vertices of a cloth.
typedef struct {
    int sub_step, walked;
    bool solved;          // there are pressures
    bool renews_masses;   // from the next sub-step on
    float greatest_mass;  // kg
    float held_tension;   // greatest K w' that no mass is raised for; infinite where masses stay as given
} apsl_walk;

// x_i += Δx_i, and on to the next part. A displacement in the part before changes the velocity by walked · Δx / Δt, and
// so carries on through the parts that are left: what it adds to the end of the step is kept in `correction`, which
// stays exactly zero where nothing is corrected.
APSL_INLINE void walk_vertices(apsl_cloth cloth, bool active, apsl_walk walk, __global const uint* corner_offsets,
                               __global const uint* corners, __global const apsl_gradients* gradients,
                               __global const float* pressure, __global float4* predicted, __global float4* motion,
                               __global float4* correction) {
    const apsl_range range = share_of(cloth.vertex_count, active);
    const float parts = (float)walk.walked;
    const float parts_left = fmax((float)(walk.walked - walk.sub_step), 1.0f);
    const float onward = walk.sub_step + 1 < walk.walked ? 1.0f / parts : 0.0f;
    for (uint v = range.first; v < range.end; v += APSL_WORK_GROUP_SIZE) {
        const uint i = cloth.vertex_begin + v;
        float4 x = predicted[i], step = motion[i];
        const float given = step.w, effective = x.w;
        step.w = 0.0f;
        if (effective > 0.0f) {
            float4 total = correction[i];
            float tension = 0.0f;  // K w'
            float4 change = (float4)(0.0f);
            if (walk.solved) {
                const apsl_corner_sums sums = sums_over_corners(corner_offsets, corners, gradients, pressure, i);
                tension = sums.stiffness;
                change = -sqrt(2.0f * effective) * sums.force;
            }
            // Of most vertices the mass stays as given, and K, which takes a division, is of no use.
            if (effective < given || tension > walk.held_tension) {
                const float stiffness = tension / effective;
                change *= share_taken(given, effective, stiffness, walk.greatest_mass);
                if (walk.renews_masses) {
                    total.w = fmax(stiffness, APSL_STIFFNESS_KEPT * total.w);
                    x.w = effective_inverse_mass(given, total.w, walk.greatest_mass);
                }
            }
            if (walk.solved) {
                x += change;  // its w is zero
                step += parts * change;
                total += parts_left * change;
                motion[i] = (float4)(step.xyz, given);
            }
            correction[i] = total;
        }
        predicted[i] = x + onward * step;
    }
}

// ṽ += (x − (x̃ + Δt ṽ)) / Δt, or what a walk's corrections add up to.
APSL_INLINE void correct_velocities(apsl_cloth cloth, bool active, float time_step, bool walking,
                                    __global const uint* vertex_order, __global const float4* predicted,
                                    __global const float4* correction, __global const float* positions,
                                    __global float* velocities) {
    const apsl_range range = share_of(cloth.vertex_count, active);
    for (uint v = range.first; v < range.end; v += APSL_WORK_GROUP_SIZE) {
        const uint place = cloth.vertex_begin + v, i = vertex_order[place];
        const float4 x = predicted[place];
        if (!(x.w > 0.0f)) continue;  // a pinned vertex keeps every bit of its velocity
        const float3 before = load_velocity(velocities, i);
        // A vertex nothing moved gets exactly zero.
        const float3 moved = walking ? correction[place].xyz
                                     : x.xyz - predicted_position(load_position(positions, i), before, time_step);
        const float3 after = before + moved * (1.0f / time_step);
        // No area vouches for a velocity that overflows.
        if (all(isfinite(after)))
            store_vector(after, velocities + (ulong)i * APSL_VELOCITY_STRIDE, APSL_VELOCITY_COMPONENT_STRIDE);
    }
}

// The caller's positions ← the corrected ones. A pinned vertex keeps every bit.
APSL_INLINE void store_positions(apsl_cloth cloth, bool active, __global const uint* vertex_order,
                                 __global const float4* predicted, __global float* positions) {
    const apsl_range range = share_of(cloth.vertex_count, active);
    for (uint v = range.first; v < range.end; v += APSL_WORK_GROUP_SIZE) {
        const uint place = cloth.vertex_begin + v;
        const float4 x = predicted[place];
        if (x.w > 0.0f && all(isfinite(x)))
            store_vector(x.xyz, positions + (ulong)vertex_order[place] * APSL_POSITION_STRIDE,
                         APSL_POSITION_COMPONENT_STRIDE);
    }
}

// What a call leaves the caller. `corrected` is the velocities, or the positions where there are none.
APSL_INLINE void store_corrections(apsl_cloth cloth, bool active, float time_step, bool walking,
                                   __global const uint* vertex_order, __global const float4* predicted,
                                   __global const float4* correction, __global const float* positions,
                                   __global float* corrected) {
#if APSL_POSITIONS_ONLY
    (void)time_step;
    (void)walking;
    (void)correction;
    (void)positions;
    store_positions(cloth, active, vertex_order, predicted, corrected);
#else
    correct_velocities(cloth, active, time_step, walking, vertex_order, predicted, correction, positions, corrected);
#endif
}

#endif
