// SPDX-License-Identifier: MIT
// What a vertex weighs in small steps: more than given where the tension around it is too stiff for its mass
// (docs/formulation.md, Effective masses). Reference: apsl::reference, effective_masses.
#ifndef APSL_EFFECTIVE_MASS_H
#define APSL_EFFECTIVE_MASS_H

#include "layout.h"

#define APSL_MASS_PER_STIFFNESS 2.0f
#define APSL_STIFFNESS_KEPT 0.9f
#define APSL_GREATEST_MEAN_MASSES 10.0f

// From Σ √m over the movable vertices and their number; kg.
APSL_INLINE float greatest_effective_mass(float root_masses, float movable) {
    const float root_mean = movable > 0.0f ? root_masses / movable : 0.0f;
    return APSL_GREATEST_MEAN_MASSES * root_mean * root_mean;
}

// 1/w' for the stiffness K, kg; `given` is w > 0. Without a reason to raise the mass, w itself.
APSL_INLINE float effective_inverse_mass(float given, float stiffness, float greatest) {
    if (!(APSL_MASS_PER_STIFFNESS * stiffness * given > 1.0f)) return given;
    return fmin(given, 1.0f / fmin(APSL_MASS_PER_STIFFNESS * stiffness, fmax(1.0f / given, greatest)));
}

// The share of its displacement that a vertex takes where the tension just found is `stiffness` K; 1 where it weighs
// at least that.
APSL_INLINE float share_taken(float given, float effective, float stiffness, float greatest) {
    const float ratio = effective * fmin(stiffness, fmax(1.0f / given, greatest));
    return ratio > 1.0f ? 1.0f / ratio : 1.0f;
}

#endif
