// SPDX-License-Identifier: MIT
// What acceleration and damping make of a velocity where a call is a whole time step (docs/formulation.md, A whole
// step). A pinned vertex keeps its velocity. Reference: apsl::reference, free_motion.
#ifndef APSLK_FREE_MOTION_H
#define APSLK_FREE_MOTION_H

#include "layout.h"

#ifndef APSLK_INTEGRATES
#define APSLK_INTEGRATES 0
#endif
#ifndef APSLK_ACCELERATION_PER_VERTEX
#define APSLK_ACCELERATION_PER_VERTEX 0
#endif

// The last argument of kernels that accelerate vertices, which they have only where each has an acceleration of its
// own: m/s², in the limiter's order of vertices; their w is zero.
#if APSLK_ACCELERATION_PER_VERTEX
#define APSLK_ACCELERATIONS_ARGUMENT , __global const float4* accelerations
#define APSLK_ACCELERATIONS accelerations
#else
#define APSLK_ACCELERATIONS_ARGUMENT
#define APSLK_ACCELERATIONS 0
#endif

// Of one small step: u ← kept (u + gain), to which a vertex adds duration times its own acceleration.
typedef struct {
    float3 gain;     // m/s
    float duration;  // s
    float kept;
    __global const float4* accelerations;
} apslk_free_part;

// Of all small steps of a time step, as many as were given, with nothing else to move the cloth: ends at kept ṽ + gain,
// and moves by Δt times mean_kept ṽ + mean_gain. A vertex' own acceleration counts for `seconds` and `mean_seconds`.
typedef struct {
    float3 gain, mean_gain;       // m/s
    float seconds, mean_seconds;  // s
    float kept, mean_kept;
    __global const float4* accelerations;
} apslk_free_step;

APSLK_INLINE apslk_free_part one_of_parts(int parts, __global const apslk_parameters* parameters,
                                          __global const float4* accelerations) {
    apslk_free_part part = {(float3)(0.0f), 0.0f, 1.0f, accelerations};
#if APSLK_INTEGRATES
    part.duration = parameters->time_step / (float)parts;
    part.gain = part.duration * vload3(0, parameters->acceleration);
    part.kept = exp(-parameters->damping * part.duration);
#else
    (void)parts;
    (void)parameters;
#endif
    return part;
}

APSLK_INLINE apslk_free_part free_part(__global const apslk_parameters* parameters,
                                       __global const float4* accelerations) {
    return one_of_parts(max(parameters->small_steps, 1), parameters, accelerations);
}

APSLK_INLINE apslk_free_step free_step(__global const apslk_parameters* parameters,
                                       __global const float4* accelerations) {
    apslk_free_step step = {(float3)(0.0f), (float3)(0.0f), 0.0f, 0.0f, 1.0f, 1.0f, accelerations};
#if APSLK_INTEGRATES
    const int parts = max(parameters->given_small_steps, 1);
    const apslk_free_part part = one_of_parts(parts, parameters, accelerations);
    float kept = 1.0f, gains = 0.0f, mean_kept = 0.0f, mean_gains = 0.0f;
    for (int k = 0; k < parts; ++k) {
        kept *= part.kept;
        gains = part.kept * (gains + 1.0f);
        mean_kept += kept;
        mean_gains += gains;
    }
    step.gain = gains * part.gain;
    step.mean_gain = mean_gains / (float)parts * part.gain;
    step.seconds = gains * part.duration;
    step.mean_seconds = mean_gains / (float)parts * part.duration;
    step.kept = kept;
    step.mean_kept = mean_kept / (float)parts;
#else
    (void)parameters;
#endif
    return step;
}

// What vertex `place` gains beside `gain`, its own acceleration counting for `seconds`.
APSLK_INLINE float3 with_own_gain(float3 gain, float seconds, __global const float4* accelerations, uint place) {
#if APSLK_ACCELERATION_PER_VERTEX
    return gain + seconds * accelerations[place].xyz;
#else
    (void)seconds;
    (void)accelerations;
    (void)place;
    return gain;
#endif
}

APSLK_INLINE float3 gain_of_free_part(apslk_free_part part, uint place) {
    return with_own_gain(part.gain, part.duration, part.accelerations, place);
}

APSLK_INLINE float3 after_free_part(apslk_free_part part, uint place, float3 velocity, float inverse_mass) {
    return APSLK_INTEGRATES && inverse_mass > 0.0f ? part.kept * (velocity + gain_of_free_part(part, place)) : velocity;
}

// m/s, what acceleration adds to the velocity of a vertex that can move.
APSLK_INLINE float3 gain_of_free_step(apslk_free_step step, uint place) {
    return with_own_gain(step.gain, step.seconds, step.accelerations, place);
}

APSLK_INLINE float3 after_free_step(apslk_free_step step, uint place, float3 velocity, float inverse_mass) {
    const float3 gain = gain_of_free_step(step, place);
    return APSLK_INTEGRATES && inverse_mass > 0.0f ? step.kept * velocity + gain : velocity;
}

APSLK_INLINE float3 mean_of_free_step(apslk_free_step step, uint place, float3 velocity, float inverse_mass) {
    const float3 gain = with_own_gain(step.mean_gain, step.mean_seconds, step.accelerations, place);
    return APSLK_INTEGRATES && inverse_mass > 0.0f ? step.mean_kept * velocity + gain : velocity;
}

#endif
