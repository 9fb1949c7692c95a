// SPDX-License-Identifier: MIT
// What a vertex weighs in small steps: more than given where the tension around it is too stiff for its mass
// (docs/formulation.md, Effective masses). Reference: apsl::reference, effective_masses.
#ifndef APSL_EFFECTIVE_MASS_H
#define APSL_EFFECTIVE_MASS_H

#include "layout.h"
#include "work_group.h"

#define APSL_MASS_PER_STIFFNESS 2.0f
#define APSL_STIFFNESS_KEPT 0.9f
#define APSL_GREATEST_MEAN_MASSES 10.0f

// From Σ log₂ m over the movable vertices and their number; kg.
APSL_INLINE float greatest_effective_mass(float log_masses, float movable) {
    return movable > 0.0f ? APSL_GREATEST_MEAN_MASSES * exp2(log_masses / movable) : 0.0f;
}

// The greatest K w that a mass is enough for.
#define APSL_HELD_TENSION (1.0f / APSL_MASS_PER_STIFFNESS)

// 1/w' for the stiffness K, kg; `given` is w > 0. Without a reason to raise the mass, w itself.
APSL_INLINE float effective_inverse_mass(float given, float stiffness, float greatest) {
    if (!(stiffness * given > APSL_HELD_TENSION)) return given;
    return fmin(given, 1.0f / fmin(APSL_MASS_PER_STIFFNESS * stiffness, fmax(1.0f / given, greatest)));
}

// The share of its displacement that a vertex takes where the tension just found is `stiffness` K; 1 where it weighs
// at least that.
APSL_INLINE float share_taken(float given, float effective, float stiffness, float greatest) {
    const float ratio = effective * fmin(stiffness, fmax(1.0f / given, greatest));
    return ratio > 1.0f ? 1.0f / ratio : 1.0f;
}

typedef struct {
    float count;           // vertices that weigh more than given
    float greatest_ratio;  // w over w', 1 where there are none
} apsl_raised_masses;

// This work-item's. `motion` holds w.
APSL_INLINE apsl_raised_masses raised_masses(apsl_cloth cloth, bool active, __global const float4* predicted,
                                             __global const float4* motion) {
    const apsl_range range = share_of(cloth.vertex_count, active);
    apsl_raised_masses raised = {0.0f, 1.0f};
    for (uint v = range.first; v < range.end; v += APSL_WORK_GROUP_SIZE) {
        const float effective = predicted[cloth.vertex_begin + v].w, given = motion[cloth.vertex_begin + v].w;
        if (effective < given) {
            raised.count += 1.0f;
            raised.greatest_ratio = fmax(raised.greatest_ratio, given / effective);
        }
    }
    return raised;
}

#endif
