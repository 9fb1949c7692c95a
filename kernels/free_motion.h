// SPDX-License-Identifier: MIT
// What acceleration and damping make of a velocity where a call is a whole time step (docs/formulation.md, A whole
// step). A pinned vertex keeps its velocity. Reference: apsl::reference, free_motion.
#ifndef APSLK_FREE_MOTION_H
#define APSLK_FREE_MOTION_H

#include "layout.h"

#ifndef APSLK_INTEGRATES
#define APSLK_INTEGRATES 0
#endif

// Of one small step: u ← kept (u + gain).
typedef struct {
    float3 gain;  // m/s
    float kept;
} apslk_free_part;

// Of all small steps of a time step, with nothing else to move the cloth: ends at kept ṽ + gain, and moves by Δt times
// mean_kept ṽ + mean_gain.
typedef struct {
    float3 gain, mean_gain;  // m/s
    float kept, mean_kept;
} apslk_free_step;

APSLK_INLINE apslk_free_part free_part(__global const apslk_parameters* parameters) {
    apslk_free_part part = {(float3)(0.0f), 1.0f};
#if APSLK_INTEGRATES
    const float duration = parameters->time_step / (float)max(parameters->small_steps, 1);
    part.gain = duration * vload3(0, parameters->acceleration);
    part.kept = exp(-parameters->damping * duration);
#else
    (void)parameters;
#endif
    return part;
}

APSLK_INLINE apslk_free_step free_step(__global const apslk_parameters* parameters) {
    apslk_free_step step = {(float3)(0.0f), (float3)(0.0f), 1.0f, 1.0f};
#if APSLK_INTEGRATES
    const apslk_free_part part = free_part(parameters);
    const int parts = max(parameters->small_steps, 1);
    float kept = 1.0f, gains = 0.0f, mean_kept = 0.0f, mean_gains = 0.0f;
    for (int k = 0; k < parts; ++k) {
        kept *= part.kept;
        gains = part.kept * (gains + 1.0f);
        mean_kept += kept;
        mean_gains += gains;
    }
    step.gain = gains * part.gain;
    step.mean_gain = mean_gains / (float)parts * part.gain;
    step.kept = kept;
    step.mean_kept = mean_kept / (float)parts;
#else
    (void)parameters;
#endif
    return step;
}

APSLK_INLINE float3 after_free_part(apslk_free_part part, float3 velocity, float inverse_mass) {
    return APSLK_INTEGRATES && inverse_mass > 0.0f ? part.kept * (velocity + part.gain) : velocity;
}

APSLK_INLINE float3 after_free_step(apslk_free_step step, float3 velocity, float inverse_mass) {
    return APSLK_INTEGRATES && inverse_mass > 0.0f ? step.kept * velocity + step.gain : velocity;
}

APSLK_INLINE float3 mean_of_free_step(apslk_free_step step, float3 velocity, float inverse_mass) {
    return APSLK_INTEGRATES && inverse_mass > 0.0f ? step.mean_kept * velocity + step.mean_gain : velocity;
}

#endif
