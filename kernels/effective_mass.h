// SPDX-License-Identifier: MIT
// What a vertex weighs in small steps: more than given where the tension around it is too stiff for its mass
// (docs/formulation.md, Effective masses). Reference: apsl::reference, effective_masses.
#ifndef APSLK_EFFECTIVE_MASS_H
#define APSLK_EFFECTIVE_MASS_H

#include "layout.h"
#include "work_group.h"

// From Σ log₂ m over the movable vertices and their number; kg.
APSLK_INLINE float greatest_effective_mass(float log_masses, float movable) {
    return movable > 0.0f ? APSLK_GREATEST_MEAN_MASSES * exp2(log_masses / movable) : 0.0f;
}

// The greatest K w that a mass is enough for.
#define APSLK_HELD_TENSION (1.0f / APSLK_MASS_PER_STIFFNESS)

// 1/w' for the stiffness K, kg; `given` is w > 0. Without a reason to raise the mass, w itself.
APSLK_INLINE float effective_inverse_mass(float given, float stiffness, float greatest) {
    if (!(stiffness * given > APSLK_HELD_TENSION)) return given;
    return fmin(given, 1.0f / fmin(APSLK_MASS_PER_STIFFNESS * stiffness, fmax(1.0f / given, greatest)));
}

// The share of its displacement that a vertex takes where the tension just found is `stiffness` K; 1 where it weighs
// at least that.
APSLK_INLINE float share_taken(float given, float effective, float stiffness, float greatest) {
    const float ratio = effective * fmin(stiffness, fmax(1.0f / given, greatest));
    return ratio > 1.0f ? 1.0f / ratio : 1.0f;
}

// With a stretch ceiling (docs/formulation.md, Stretch ceiling): 1/w' for the stiffness K, kg. `given` is w > 0.
// Reference: apsl::reference, stretch_limiting.
APSLK_INLINE float inverse_mass_under_tension(float given, float stiffness) {
    if (!(stiffness > 0.0f)) return given;
    return fmax(1.0f / (1.0f / given + APSLK_MASS_ADDED_PER_STIFFNESS * stiffness), given / APSLK_GREATEST_MASS_RATIO);
}

// What a vertex keeps of its velocity. Mass beyond the ratio that sub-steps aim at resists a change of velocity and
// carries none: motion of what is too stiff to resolve would else weigh ever more, and feed the cloth around it.
APSLK_INLINE float velocity_kept(float given, float effective) {
    return fmin(1.0f, APSLK_AIMED_MASS_RATIO * effective / given);
}

// The K that counts, from K w'. With what is already added the same tension comes out heavier: the fourth root keeps
// that from running away.
APSLK_INLINE float counted_stiffness(float given, float effective, float tension) {
    return tension / effective * sqrt(sqrt(effective / given));
}

typedef struct {
    float count;           // vertices that weigh more than given
    float greatest_ratio;  // w over w', 1 where there are none
} apslk_raised_masses;

// This work-item's. `motion` holds w.
APSLK_INLINE apslk_raised_masses raised_masses(apslk_cloth cloth, bool active, __global const float4* moved,
                                               __global const float4* motion) {
    const apslk_range range = share_of(cloth.vertex_count, active);
    apslk_raised_masses raised = {0.0f, 1.0f};
    for (uint v = range.first; v < range.end; v += APSLK_WORK_GROUP_SIZE) {
        const float effective = moved[cloth.vertex_begin + v].w, given = motion[cloth.vertex_begin + v].w;
        if (effective < given) {
            raised.count += 1.0f;
            raised.greatest_ratio = fmax(raised.greatest_ratio, given / effective);
        }
    }
    return raised;
}

#endif
