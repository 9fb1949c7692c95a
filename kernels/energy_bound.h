// SPDX-License-Identifier: MIT
// What a whole step may leave of kinetic energy (docs/formulation.md, Energy). Reference: apsl::reference,
// energy_bound.
#ifndef APSLK_ENERGY_BOUND_H
#define APSLK_ENERGY_BOUND_H

#include "contact.h"
#include "free_motion.h"
#include "layout.h"
#include "work_group.h"

// Over vertices: what those that move carry where nothing but acceleration and damping acts, the box around the
// velocities of pins, and whether anything is within reach.
typedef struct {
    float3 momentum;                    // kg m/s
    float mass;                         // kg
    float3 greatest, greatest_reverse;  // m/s, of pins: u and -u; -FLT_MAX where there are none
    float touches;                      // 0 or 1
} apslk_drive_sums;

APSLK_INLINE apslk_drive_sums no_drive(void) {
    const apslk_drive_sums sums = {(float3)(0.0f), 0.0f, (float3)(-FLT_MAX), (float3)(-FLT_MAX), 0.0f};
    return sums;
}

// Whether a vertex that ends the step at `x` with `velocity`, both free, comes within reach of its body: what the two
// move by in a step at their speed against one another.
APSLK_INLINE bool comes_near(float3 x, float3 velocity, float time_step, __global const float* contacts, uint vertex) {
#if APSLK_KEEPS_CONTACTS
    const float4 plane = vload4(2ul * vertex, contacts);
    const float3 body = vload4(2ul * vertex + 1ul, contacts).xyz;
    const float gap = dot(plane.xyz, x) - plane.w;
    return any(plane.xyz != 0.0f) && gap <= time_step * length(velocity - body);
#else
    (void)x;
    (void)velocity;
    (void)time_step;
    (void)contacts;
    (void)vertex;
    return false;
#endif
}

// `velocity`: at the end of the step, free. `near`: see comes_near.
APSLK_INLINE void add_to_drive(apslk_drive_sums* sums, float3 velocity, float inverse_mass, bool near) {
    if (inverse_mass > 0.0f) {
        sums->momentum += velocity / inverse_mass;
        sums->mass += 1.0f / inverse_mass;
        if (near) sums->touches = 1.0f;
    } else {
        sums->greatest = fmax(sums->greatest, velocity);
        sums->greatest_reverse = fmax(sums->greatest_reverse, -velocity);  // Intel loses a running fmin
    }
}

// A kind of partial results for each of x, y and z.
APSLK_INLINE void store_partial_sums_xyz(__global float* partials, uint kind, float3 v, __local float* scratch) {
    store_partial(partials, kind, group_sum(v.x, scratch));
    store_partial(partials, kind + 1u, group_sum(v.y, scratch));
    store_partial(partials, kind + 2u, group_sum(v.z, scratch));
}

APSLK_INLINE void store_partial_maxima_xyz(__global float* partials, uint kind, float3 v, __local float* scratch) {
    store_partial(partials, kind, group_max(v.x, scratch));
    store_partial(partials, kind + 1u, group_max(v.y, scratch));
    store_partial(partials, kind + 2u, group_max(v.z, scratch));
}

APSLK_INLINE float3 sum_partials_xyz(__global float* partials, uint kind, uint groups, __local float* scratch) {
    const float x = sum_partials(partials, kind, groups, scratch);
    const float y = sum_partials(partials, kind + 1u, groups, scratch);
    return (float3)(x, y, sum_partials(partials, kind + 2u, groups, scratch));
}

APSLK_INLINE float3 max_partials_xyz(__global float* partials, uint kind, uint groups, __local float* scratch) {
    const float x = max_partials(partials, kind, groups, scratch);
    const float y = max_partials(partials, kind + 1u, groups, scratch);
    return (float3)(x, y, max_partials(partials, kind + 2u, groups, scratch));
}

APSLK_INLINE void store_drive_partials(apslk_drive_sums sums, __global float* partials, __local float* scratch) {
    store_partial(partials, APSLK_PARTIAL_MASS, group_sum(sums.mass, scratch));
    store_partial_sums_xyz(partials, APSLK_PARTIAL_MOMENTUM, sums.momentum, scratch);
    store_partial_maxima_xyz(partials, APSLK_PARTIAL_GREATEST_PIN, sums.greatest, scratch);
    store_partial_maxima_xyz(partials, APSLK_PARTIAL_LEAST_PIN, sums.greatest_reverse, scratch);
    store_partial(partials, APSLK_PARTIAL_TOUCHES, group_max(sums.touches, scratch));
}

// What drives a cloth, and the frame that energies are measured in.
typedef struct {
    float3 velocity;  // m/s, of the frame
    float pins;       // m/s, of pins there
    float mass;       // kg, of vertices that move
    bool flies;       // nothing holds it or is within its reach
} apslk_drive;

// The frame is the middle of the box around the velocities of the pins. Of a cloth without pins it is its own mean
// velocity, or, where something is within its reach, what stands still.
APSLK_INLINE apslk_drive find_drive(__global float* partials, uint groups, __local float* scratch) {
    const float3 momentum = sum_partials_xyz(partials, APSLK_PARTIAL_MOMENTUM, groups, scratch);
    const float3 greatest = max_partials_xyz(partials, APSLK_PARTIAL_GREATEST_PIN, groups, scratch);
    const float3 least = -max_partials_xyz(partials, APSLK_PARTIAL_LEAST_PIN, groups, scratch);
    const bool touches = max_partials(partials, APSLK_PARTIAL_TOUCHES, groups, scratch) > 0.0f;
    const float mass = sum_partials(partials, APSLK_PARTIAL_MASS, groups, scratch);
    const bool pinned = greatest.x >= least.x;
    apslk_drive drive;
    drive.mass = mass;
    drive.flies = !pinned && !touches && mass > 0.0f;
    drive.velocity = (float3)(0.0f);
    drive.pins = 0.0f;
    if (pinned) {
        drive.velocity = 0.5f * least + 0.5f * greatest;
        drive.pins = length(0.5f * greatest - 0.5f * least);
    } else if (drive.flies) {
        drive.velocity = momentum / mass;
    }
    return drive;
}

// m²/s²: what a body adds at most to the square of the velocity of the vertex near it, both in the frame. It pushes
// along its normal up to its own speed there, and drags along its surface where there is friction. A body that is
// faster than the vertex also sets in motion what hangs on it.
APSLK_INLINE float added_by_body(float3 velocity, float3 frame, __global const float* contacts, uint vertex) {
#if APSLK_KEEPS_CONTACTS
    const float3 normal = vload4(2ul * vertex, contacts).xyz;
    const float4 surface = vload4(2ul * vertex + 1ul, contacts);
    const float3 body = surface.xyz - frame, own = velocity - frame;
    const float pushing = dot(body, normal), into = dot(own, normal);
    const float3 slip = along_surface(own, normal), drag = along_surface(body, normal);
    const float pushed = pushing > into ? fmax(pushing * pushing - into * into, 0.0f) : 0.0f;
    const float dragged = surface.w > 0.0f ? fmax(dot(drag, drag) - dot(slip, slip), 0.0f) : 0.0f;
    const float pulled = dot(body, body) > dot(own, own) ? APSLK_PULLED_ALONG : 1.0f;
    return pulled * (pushed + dragged);
#else
    (void)velocity;
    (void)frame;
    (void)contacts;
    (void)vertex;
    return 0.0f;
#endif
}

// J, of all parts: what hinges held at the start, less what they held at the start of the last part of several.
APSLK_INLINE float bending_given(float at_start, float left, int parts) {
    const float count = (float)parts;
    return fmax(at_start - left, 0.0f) * count / fmax(count - 1.0f, 1.0f);
}

// Σ m |u|² there, kg m²/s².
typedef struct {
    float free;                            // at the free end of the step, with what hinges gave
    float pins;                            // of all mass at the speed of the pins
    float bodies;                          // what bodies add
    float unmet, met;                      // as the step left it, of vertices outside their limits and of the others
    float gained_by_unmet, gained_by_met;  // of that, what vertices have more than at the free end
} apslk_energies;

// What vertices keep: a share of their velocities there, and of what they gained of energy.
typedef struct {
    float speed, unmet_gain, met_gain;
} apslk_kept_shares;

// Pins bring a cloth to twice their speed at most.
APSLK_INLINE float allowed_energy(apslk_energies of) {
    const float free = sqrt(of.free), pins = sqrt(of.pins);
    const float root = fmax(free, fmin(free + pins, 2.0f * pins)) + sqrt(of.bodies);
    return root * root;
}

// A cloth that `flies` keeps its momentum: it is slowed as a whole.
APSLK_INLINE apslk_kept_shares shares_kept_by_energy(apslk_energies of, float allowed, bool flies) {
    apslk_kept_shares kept = {1.0f, 1.0f, 1.0f};
    const float left = of.unmet + of.met, over = left - allowed;
    if (!(of.unmet > 0.0f) || !(left > APSLK_ENERGY_LET_PASS * allowed)) return kept;
    if (flies) {
        kept.speed = sqrt(allowed / left);
        return kept;
    }
    kept.unmet_gain = over < of.gained_by_unmet ? 1.0f - over / of.gained_by_unmet : 0.0f;
    kept.met_gain =
        over > of.gained_by_unmet ? fmax(1.0f - (over - of.gained_by_unmet) / of.gained_by_met, 0.0f) : 1.0f;
    return kept;
}

// Of the velocity of a vertex, from squares of its speed there at the end and at the free end of the step.
APSLK_INLINE float share_of_velocity(apslk_kept_shares kept, bool unmet, float square, float free_square) {
    const float gain = unmet ? kept.unmet_gain : kept.met_gain;
    return kept.speed * (square > free_square ? sqrt(gain + (1.0f - gain) * (free_square / square)) : 1.0f);
}

#endif
