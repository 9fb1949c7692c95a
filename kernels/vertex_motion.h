// SPDX-License-Identifier: MIT
// How vertices move: Algorithm 1, line 1 (predict), line 6 with Eq. (6) (displace) and its output (velocities); and
// with small steps the way there. Reference: apsl::reference, strain_limiter and displacements.
#ifndef APSLK_VERTEX_MOTION_H
#define APSLK_VERTEX_MOTION_H

#include "caller_vectors.h"
#include "contact.h"
#include "effective_mass.h"
#include "energy_bound.h"
#include "free_motion.h"
#include "gradients.h"
#include "layout.h"
#include "limits_stretch.h"
#include "small_steps.h"
#include "tethers.h"
#include "vertex_gather.h"
#include "work_group.h"

// Into the limiter's order of vertices, for what `free` then gives them.
APSLK_INLINE void order_accelerations(apslk_cloth cloth, bool active, __global const uint* vertex_order,
                                      __global float4* ordered, __global const float* accelerations) {
    const apslk_range range = share_of(cloth.vertex_count, active);
    for (uint v = range.first; v < range.end; v += APSLK_WORK_GROUP_SIZE) {
        const uint place = cloth.vertex_begin + v;
        ordered[place] = (float4)(load_position(accelerations, vertex_order[place]), 0.0f);
    }
}

// x̃ + Δt ṽ of the caller's vertex, ṽ as `free` has it, outside of what it touches, and Δt times the velocity at the
// end. Where there are no velocities, `velocities` is the positions, in and out, and this the position as given, to the
// bit: one pointer in place of two, which the large kernel has no registers for.
APSLK_INLINE apslk_moving_vertex end_of_step(__global const float* positions, __global const float* velocities,
                                             uint place, uint vertex, float inverse_mass, float time_step,
                                             apslk_free_step free, __global const float* contacts) {
#if APSLK_POSITIONS_ONLY
    (void)positions;
    (void)place;
    (void)time_step;
    (void)inverse_mass;
    (void)free;
    (void)contacts;
    const apslk_moving_vertex end = {load_position(velocities, vertex), (float3)(0.0f), (float3)(0.0f), false};
    return end;
#else
    const float3 start = load_position(positions, vertex), velocity = load_velocity(velocities, vertex);
    const float3 x = predicted_position(start, mean_of_free_step(free, place, velocity, inverse_mass), time_step);
    const apslk_moving_vertex end = {x, time_step * after_free_step(free, place, velocity, inverse_mass), x - start,
                                     false};
    return inverse_mass > 0.0f ? kept_outside(end, contacts, vertex, end_of_the_step(time_step)) : end;
#endif
}

// Of (x̃ + Δt ṽ, inverse mass). A position or velocity that is not finite leaves nothing finite.
APSLK_INLINE bool is_bad_vertex(float4 moved) {
    return !isfinite(moved.x) || !isfinite(moved.y) || !isfinite(moved.z) || !isfinite(moved.w) || moved.w < 0.0f;
}

typedef struct {
    float bad;         // vertices
    float log_masses;  // Σ log₂ m of movable vertices
    float movable;     // vertices
    float extent;      // greatest |coordinate|, m
#if APSLK_INTEGRATES
    apslk_drive_sums drive;
#endif
} apslk_vertex_sums;

// moved = (x̃ + Δt ṽ outside of contacts, w), and before small steps motion = (x̃, w), in the limiter's order of
// vertices. Returns this work-item's sums.
APSLK_INLINE apslk_vertex_sums predict_vertices(apslk_cloth cloth, bool active, float time_step, apslk_free_step free,
                                                bool in_small_steps, __global const uint* vertex_order,
                                                __global float4* moved, __global float4* motion,
                                                __global const float* positions, __global const float* velocities,
                                                __global const float* inverse_masses, __global const float* contacts) {
    const apslk_range range = share_of(cloth.vertex_count, active);
    apslk_vertex_sums sums;
    sums.bad = 0.0f;
    sums.log_masses = 0.0f;
    sums.movable = 0.0f;
    sums.extent = 0.0f;
#if APSLK_INTEGRATES
    sums.drive = no_drive();
#endif
    for (uint v = range.first; v < range.end; v += APSLK_WORK_GROUP_SIZE) {
        const uint place = cloth.vertex_begin + v, i = vertex_order[place];
        const float w = inverse_masses[(ulong)i * APSLK_INVERSE_MASS_STRIDE];
        const float4 x =
            (float4)(end_of_step(positions, velocities, place, i, w, time_step, free, contacts).position, w);
        moved[place] = x;
        if (in_small_steps) motion[place] = (float4)(load_position(positions, i), w);
        sums.bad += is_bad_vertex(x) ? 1.0f : 0.0f;
        sums.log_masses += w > 0.0f ? -log2(w) : 0.0f;
        sums.movable += w > 0.0f ? 1.0f : 0.0f;
        sums.extent = fmax(sums.extent, fmax(fabs(x.x), fmax(fabs(x.y), fabs(x.z))));
#if APSLK_INTEGRATES
        const float3 velocity = after_free_step(free, place, load_velocity(velocities, i), w);
        add_to_drive(&sums.drive, velocity, w, comes_near(x.xyz, velocity, time_step, contacts, i));
#endif
    }
    return sums;
}

// The first of `small_steps` parts of the step, with its `free` part: moved = x̃ + Δt ṽ / small_steps, motion = (Δt ṽ,
// w), total_correction = 0. The w of `total_correction` is the kept stiffness K, 0 where it never was too much.
APSLK_INLINE void begin_small_steps(apslk_cloth cloth, bool active, float time_step, apslk_free_part free,
                                    int small_steps, __global const uint* vertex_order, __global float4* moved,
                                    __global float4* motion, __global float4* total_correction,
                                    __global const float* velocities, apslk_tethers tethers) {
    const apslk_range range = share_of(cloth.vertex_count, active);
    const float part = 1.0f / (float)small_steps;
    for (uint v = range.first; v < range.end; v += APSLK_WORK_GROUP_SIZE) {
        const uint place = cloth.vertex_begin + v, vertex = vertex_order[place];
        const float3 velocity = load_velocity(velocities, vertex);
        const float4 start = motion[place];
        const apslk_move first_part = {part, part * time_step, time_step};
        float3 step = time_step * after_free_part(free, place, velocity, start.w);
        if (start.w > 0.0f) step = within_reach(start.xyz, step, first_part, tethers, cloth, vertex);
        moved[place] = (float4)(fma((float3)(part), step, start.xyz), start.w);
        motion[place] = (float4)(step, start.w);
        total_correction[place] = (float4)(0.0f);
    }
}

// x_i += Δx_i = −w_i Σ_{a∋i} λ_a g_{a,i}, in scaled terms −√(2 w_i) Σ y_a ḡ_{a,i}; its w is zero.
APSLK_INLINE void displace_vertices(apslk_cloth cloth, bool active, __global const uint* corner_offsets,
                                    __global const uint* corners, __global const apslk_gradients* gradients,
                                    __global const float* pressure, __global float4* moved) {
    const apslk_range range = share_of(cloth.vertex_count, active);
    for (uint v = range.first; v < range.end; v += APSLK_WORK_GROUP_SIZE) {
        const uint i = cloth.vertex_begin + v;
        const float4 x = moved[i];
        // One expression, which the compiler may fuse.
        if (x.w > 0.0f)
            moved[i] =
                x - sqrt(2.0f * x.w) * sum_over_corners(corner_offsets, corners, gradients, pressure, cloth.run, i);
    }
}

// One of the small steps. The same for all vertices of a cloth.
typedef struct {
    int sub_step, small_steps;
    bool solved;          // there are pressures
    bool renews_masses;   // from the next sub-step on
    float greatest_mass;  // kg
    float held_tension;   // greatest K w' that no mass is raised for; infinite where masses stay as given
} apslk_small_step;

// What the vertices of a cloth touch.
typedef struct {
    __global const float* contacts;  // Buffers::contacts
    __global const uint* vertex_order;
    float time_step;  // s
} apslk_touched;

// Vertex `place` out of what it touches: its position, Δt times its velocity, and what that adds to the end of the
// step.
APSLK_INLINE void keep_in_small_step(float4* x, float4* step, float4* total, apslk_touched touched, uint place,
                                     apslk_small_step small_step) {
#if APSLK_KEEPS_CONTACTS
    const float parts = (float)small_step.small_steps;
    const float share_left = fmax(parts - (float)(small_step.sub_step + 1), 0.0f) / parts;
    const uint vertex = touched.vertex_order[place];
    const apslk_moment now = {touched.time_step, share_left, 1.0f / parts};
    // What mends positions after the last part has no speed.
    const bool mends = small_step.sub_step >= small_step.small_steps;
    const float3 motion = mends ? touched.time_step * vload4(2ul * vertex + 1ul, touched.contacts).xyz : step->xyz;
    const apslk_moving_vertex at = {x->xyz, motion, motion / parts, false};
    const apslk_moving_vertex kept = kept_outside(at, touched.contacts, vertex, now);
    if (!kept.touches) return;
    total->xyz += kept.position - x->xyz + share_left * (kept.motion - motion);
    x->xyz = kept.position;
    if (!mends) step->xyz = kept.motion;
#else
    (void)x;
    (void)step;
    (void)total;
    (void)touched;
    (void)place;
    (void)small_step;
#endif
}

// x_i += Δx_i, and on to the next part. A displacement in the part before changes the velocity by small_steps · Δx /
// Δt, and so carries on through the parts that are left: what it adds to the end of the step is kept in
// `total_correction`, which stays exactly zero where nothing is corrected. What is touched pushes in the same way.
APSLK_INLINE void advance_vertices(apslk_cloth cloth, bool active, apslk_small_step small_step, apslk_free_part free,
                                   __global const uint* corner_offsets, __global const uint* corners,
                                   __global const apslk_gradients* gradients, __global const float* pressure,
                                   __global float4* moved, __global float4* motion, __global float4* total_correction,
                                   apslk_touched touched, apslk_tethers tethers) {
    const apslk_range range = share_of(cloth.vertex_count, active);
    const float parts = (float)small_step.small_steps;
    const float parts_left = fmax((float)(small_step.small_steps - small_step.sub_step), 1.0f);
    const float onward = small_step.sub_step + 1 < small_step.small_steps ? 1.0f / parts : 0.0f;
    for (uint v = range.first; v < range.end; v += APSLK_WORK_GROUP_SIZE) {
        const uint i = cloth.vertex_begin + v;
        float4 x = moved[i], step = motion[i];
        const float given = step.w, effective = x.w;
        step.w = 0.0f;
        if (effective > 0.0f) {
            float4 total = total_correction[i];
            float tension = 0.0f;  // K w'
            float4 change = (float4)(0.0f);
            if (small_step.solved) {
                const apslk_corner_sums sums =
                    sums_over_corners(corner_offsets, corners, gradients, pressure, cloth.run, i);
                tension = sums.stiffness;
                change = -sqrt(2.0f * effective) * sums.force;
            }
#if APSLK_LIMITS_STRETCH
            const float stiffness = counted_stiffness(given, effective, tension);
            const float taken = fmin(inverse_mass_under_tension(given, stiffness), effective);
            change *= taken / effective;
            const float kept = velocity_kept(given, taken);
            if (small_step.renews_masses) {
                total.w = fmax(stiffness, APSLK_STIFFNESS_KEPT * total.w);
                x.w = inverse_mass_under_tension(given, total.w);
            }
#else
            // Of most vertices the mass stays as given, and K, which takes a division, is of no use.
            if (effective < given || tension > small_step.held_tension) {
                const float stiffness = tension / effective;
                change *= share_taken(given, effective, stiffness, small_step.greatest_mass);
                if (small_step.renews_masses) {
                    total.w = fmax(stiffness, APSLK_STIFFNESS_KEPT * total.w);
                    x.w = effective_inverse_mass(given, total.w, small_step.greatest_mass);
                }
            }
#endif
            if (small_step.solved) {
                x += change;  // its w is zero
                total += parts_left * change;
#if APSLK_INTEGRATES
                // After the last part only positions are mended.
                if (small_step.sub_step < small_step.small_steps) {
                    step += parts * change;
#if APSLK_LIMITS_STRETCH
                    step *= kept;
#endif
                }
            }
            keep_in_small_step(&x, &step, &total, touched, i, small_step);
            if (onward > 0.0f) {
                const float time = (float)(small_step.sub_step + 2) * onward * touched.time_step;
                const apslk_move next_part = {onward, time, touched.time_step};
                const float3 free_step = after_free_part(free, i, step.xyz, given);
                step.xyz = within_reach(x.xyz, free_step, next_part, tethers, cloth, touched.vertex_order[i]);
            }
            motion[i] = (float4)(step.xyz, given);
#else
                step += parts * change;
#if APSLK_LIMITS_STRETCH
                total += (parts_left - 1.0f) / parts * (kept - 1.0f) * step;
                step *= kept;
#endif
#if !APSLK_KEEPS_CONTACTS
                motion[i] = (float4)(step.xyz, given);
#endif
            }
#if APSLK_KEEPS_CONTACTS
            keep_in_small_step(&x, &step, &total, touched, i, small_step);
            motion[i] = (float4)(step.xyz, given);
#endif
            (void)free;
            (void)touched;
            (void)tethers;
#endif
            total_correction[i] = total;
        }
        moved[i] = x + onward * step;
    }
}

// ṽ += (x − (x̃ + Δt ṽ)) / Δt, or what the corrections of small steps add up to. Not `limited`: what keeps the end of
// the step outside of contacts.
APSLK_INLINE void correct_velocities(apslk_cloth cloth, bool active, bool limited, float time_step, bool in_small_steps,
                                     __global const uint* vertex_order, __global const float4* moved,
                                     __global const float4* total_correction, __global const float* positions,
                                     __global float* velocities, __global const float* contacts) {
    const apslk_range range = share_of(cloth.vertex_count, active);
    for (uint v = range.first; v < range.end; v += APSLK_WORK_GROUP_SIZE) {
        const uint place = cloth.vertex_begin + v, i = vertex_order[place];
        const float4 x = moved[place];
        if (!(x.w > 0.0f)) continue;  // a pinned vertex keeps every bit of its velocity
        const float3 before = load_velocity(velocities, i);
        const float3 end = predicted_position(load_position(positions, i), before, time_step);
        // A vertex nothing moved gets exactly zero.
        float3 displacement = in_small_steps ? total_correction[place].xyz : x.xyz - end;
        if (APSLK_KEEPS_CONTACTS && !limited) {
            const float3 motion = time_step * before;
            const apslk_moving_vertex at = {end, motion, motion, false};
            const apslk_moving_vertex kept = kept_outside(at, contacts, i, end_of_the_step(time_step));
            if (!kept.touches) continue;
            displacement = kept.position - end;
        }
        const float3 after = before + displacement * (1.0f / time_step);
        // No area vouches for a velocity that overflows.
        if (all(isfinite(after)))
            store_vector(after, velocities + (ulong)i * APSLK_VELOCITY_STRIDE, APSLK_VELOCITY_COMPONENT_STRIDE);
    }
}

// The caller's positions ← the corrected ones. A pinned vertex keeps every bit.
APSLK_INLINE void store_positions(apslk_cloth cloth, bool active, __global const uint* vertex_order,
                                  __global const float4* moved, __global float* positions) {
    const apslk_range range = share_of(cloth.vertex_count, active);
    for (uint v = range.first; v < range.end; v += APSLK_WORK_GROUP_SIZE) {
        const uint place = cloth.vertex_begin + v;
        const float4 x = moved[place];
        if (x.w > 0.0f && all(isfinite(x)))
            store_vector(x.xyz, positions + (ulong)vertex_order[place] * APSLK_POSITION_STRIDE,
                         APSLK_POSITION_COMPONENT_STRIDE);
    }
}

// Where a whole step ends. `limited`: as moved and motion have it, with the velocity that `kept` leaves in a frame that
// moves with `drive`; otherwise as `free` and contacts have it. A vertex whose end is not finite stays.
APSLK_INLINE void store_end_of_step(apslk_cloth cloth, bool active, bool limited, float3 drive, apslk_kept_shares kept,
                                    float time_step, apslk_free_step free, __global const uint* vertex_order,
                                    __global const float4* moved, __global const float4* motion,
                                    __global float* positions, __global float* velocities,
                                    __global const float* contacts) {
    const apslk_range range = share_of(cloth.vertex_count, active);
    for (uint v = range.first; v < range.end; v += APSLK_WORK_GROUP_SIZE) {
        const uint place = cloth.vertex_begin + v, i = vertex_order[place];
        const float4 end = moved[place], step = motion[place];
        const float3 before = load_velocity(velocities, i);
        const bool moves = limited && step.w > 0.0f;
        const apslk_moving_vertex unlimited =
            end_of_step(positions, velocities, place, i, step.w, time_step, free, contacts);
        const float3 free_velocity = after_free_step(free, place, before, step.w);
        const float3 free_after = unlimited.touches ? unlimited.motion * (1.0f / time_step) : free_velocity;
        const float3 limited_after = velocity_left(kept, drive, step.xyz * (1.0f / time_step), free_velocity);
        const float3 after = moves ? limited_after : free_after;
        const float3 x = moves ? end.xyz : unlimited.position;
        if (!all(isfinite(after)) || !all(isfinite(x))) continue;
        store_vector(x, positions + (ulong)i * APSLK_POSITION_STRIDE, APSLK_POSITION_COMPONENT_STRIDE);
        // A pinned vertex keeps every bit of its velocity.
        if (step.w > 0.0f)
            store_vector(after, velocities + (ulong)i * APSLK_VELOCITY_STRIDE, APSLK_VELOCITY_COMPONENT_STRIDE);
    }
}

// What a call leaves the caller. `corrected` is the velocities, or the positions where there are none.
APSLK_INLINE void store_corrections(apslk_cloth cloth, bool active, bool limited, float time_step, bool in_small_steps,
                                    __global const uint* vertex_order, __global const float4* moved,
                                    __global const float4* total_correction, __global const float* positions,
                                    __global float* corrected, __global const float* contacts) {
#if APSLK_POSITIONS_ONLY
    (void)limited;
    (void)time_step;
    (void)in_small_steps;
    (void)total_correction;
    (void)positions;
    (void)contacts;
    store_positions(cloth, active, vertex_order, moved, corrected);
#else
    correct_velocities(cloth, active, limited, time_step, in_small_steps, vertex_order, moved, total_correction,
                       positions, corrected, contacts);
#endif
}

#endif
