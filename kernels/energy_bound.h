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
// along its normal up to its own speed there. With friction it drags along its surface, by what Coulomb's law gives for
// the speed that they close at. `pulls`: whether it is faster than the vertex. Then it also sets in motion what hangs
// on it.
APSLK_INLINE float added_by_body(float3 velocity, float3 frame, __global const float* contacts, uint vertex,
                                 bool* pulls) {
    *pulls = false;
#if APSLK_KEEPS_CONTACTS
    const float3 normal = vload4(2ul * vertex, contacts).xyz;
    const float4 surface = vload4(2ul * vertex + 1ul, contacts);
    const float3 body = surface.xyz - frame, own = velocity - frame;
    const float pushing = dot(body, normal), into = dot(own, normal);
    const float pushed = pushing > into ? fmax(pushing * pushing - into * into, 0.0f) : 0.0f;
    const float slip = length(along_surface(own, normal)), drag = length(along_surface(body, normal));
    const float dragged = fmin(drag, slip + fmax(surface.w, 0.0f) * fmax(pushing - into, 0.0f));
    *pulls = dot(body, body) > dot(own, own);
    return pushed + fmax(dragged * dragged - slip * slip, 0.0f);
#else
    (void)velocity;
    (void)frame;
    (void)contacts;
    (void)vertex;
    return 0.0f;
#endif
}

// kg m²/s², what bodies add to Σ m |u|²: what hangs on vertices that they pull along is the cloth's and counts once,
// and up to so many times these vertices' own mass.
APSLK_INLINE float added_by_bodies(float alone, float along, float pulling, float mass) {
    return alone + along * clamp(mass / fmax(pulling, FLT_MIN), 1.0f, APSLK_PULLED_ALONG);
}

// J, of all parts: what hinges held at the start, less what they held at the start of the last part of several.
APSLK_INLINE float bending_given(float at_start, float left, int parts) {
    const float count = (float)parts;
    return fmax(at_start - left, 0.0f) * count / fmax(count - 1.0f, 1.0f);
}

// Σ m |u|² there, kg m²/s².
typedef struct {
    float free;    // at the free end of the step, with what acceleration and hinges gave on the way that the cloth went
    float pins;    // of all mass at the speed of the pins
    float bodies;  // what bodies add
    float left;    // as the step left it
    float gained;  // of that, what vertices have more than at the free end
} apslk_energies;

// What vertices keep: a share of their velocities there, and of what those that gained have more than at the free end.
typedef struct {
    float speed, gain;
} apslk_kept_shares;

// Pins bring a cloth to twice their speed at most.
APSLK_INLINE float allowed_energy(apslk_energies of) {
    const float free = sqrt(fmax(of.free, 0.0f)), pins = sqrt(of.pins);
    const float root = fmax(free, fmin(free + pins, 2.0f * pins)) + sqrt(of.bodies);
    return root * root;
}

// Σ m |u|² may be this times what is allowed. What is a little off its limits corrects itself, and the cloth of the
// discrete step is a little off its energy too. `worst`: by how much the triangle that is furthest from its limits
// misses them.
APSLK_INLINE float energy_let_pass(float worst) {
    const float within = fmax(APSLK_UNMET / fmax(worst, APSLK_AT_REST) - 1.0f, 0.0f);
    return APSLK_ENERGY_LET_PASS + APSLK_ENERGY_LET_PASS_WITHIN * within;
}

// A cloth that `flies` keeps its momentum: it is slowed as a whole. So is any other, where that vertices give all that
// they gained is not enough.
APSLK_INLINE apslk_kept_shares shares_kept_by_energy(apslk_energies of, float allowed, float worst, bool flies) {
    apslk_kept_shares kept = {1.0f, 1.0f};
    const float over = of.left - allowed;
    if (!(of.left > energy_let_pass(worst) * allowed)) return kept;
    if (!flies) kept.gain = fmax(1.0f - over / of.gained, 0.0f);
    if (flies || over > of.gained) kept.speed = sqrt(allowed / (flies ? of.left : of.left - of.gained));
    return kept;
}

// Of a velocity at the end of the step, with that at its free end, in m/s. `drive`: the frame.
APSLK_INLINE float3 velocity_left(apslk_kept_shares kept, float3 drive, float3 velocity, float3 free_velocity) {
    const float3 own = velocity - drive, free = free_velocity - drive;
    if (kept.gain < 1.0f && dot(own, own) > dot(free, free))
        velocity = free_velocity + kept.gain * (velocity - free_velocity);
    return kept.speed < 1.0f ? drive + kept.speed * (velocity - drive) : velocity;
}

#endif
