// SPDX-License-Identifier: MIT
// Vectors of the caller's vertices, in the layout that Options give.
#ifndef APSLK_CALLER_VECTORS_H
#define APSLK_CALLER_VECTORS_H

#include "layout.h"

#ifndef APSLK_POSITION_STRIDE
#define APSLK_POSITION_STRIDE 3
#endif
#ifndef APSLK_VELOCITY_STRIDE
#define APSLK_VELOCITY_STRIDE 3
#endif
// From x to y to z: 1 where they lie side by side.
#ifndef APSLK_POSITION_COMPONENT_STRIDE
#define APSLK_POSITION_COMPONENT_STRIDE 1
#endif
#ifndef APSLK_VELOCITY_COMPONENT_STRIDE
#define APSLK_VELOCITY_COMPONENT_STRIDE 1
#endif
#ifndef APSLK_INVERSE_MASS_STRIDE
#define APSLK_INVERSE_MASS_STRIDE 1
#endif

APSLK_INLINE float3 load_vector(__global const float* x, ulong component_stride) {
    return component_stride == 1 ? vload3(0, x) : (float3)(x[0], x[component_stride], x[2 * component_stride]);
}

APSLK_INLINE void store_vector(float3 v, __global float* x, ulong component_stride) {
    if (component_stride == 1) {
        vstore3(v, 0, x);
    } else {
        x[0] = v.x;
        x[component_stride] = v.y;
        x[2 * component_stride] = v.z;
    }
}

// Explicitly fused, so that predicting twice gives the same bits whatever the compiler contracts.
APSLK_INLINE float3 predicted_position(float3 position, float3 velocity, float time_step) {
    return fma((float3)(time_step), velocity, position);
}

APSLK_INLINE float3 load_position(__global const float* positions, uint vertex) {
    return load_vector(positions + (ulong)vertex * APSLK_POSITION_STRIDE, APSLK_POSITION_COMPONENT_STRIDE);
}

APSLK_INLINE float3 load_velocity(__global const float* velocities, uint vertex) {
    return load_vector(velocities + (ulong)vertex * APSLK_VELOCITY_STRIDE, APSLK_VELOCITY_COMPONENT_STRIDE);
}

#endif
