// SPDX-License-Identifier: MIT
// What a vertex receives from the triangles around it: a gather over its corners in a fixed order, since OpenCL 1.2 has
// no float atomics and a gather repeats exactly.
#ifndef APSL_VERTEX_GATHER_H
#define APSL_VERTEX_GATHER_H

#include "gradients.h"
#include "layout.h"

// Σ_{a∋i} values_a ḡ_{a,i}; w is zero.
APSL_INLINE float4 sum_over_corners(__global const uint* corner_offsets, __global const uint* corners,
                                    __global const apsl_gradients* gradients, __global const float* values, uint i) {
    float4 sum = (float4)(0.0f);
    const uint end = corner_offsets[i + 1];
    for (uint n = corner_offsets[i]; n < end; ++n) {
        const uint corner = corners[n];
        sum += values[APSL_CORNER_TRIANGLE(corner)] * corner_gradient(gradients, corner);
    }
    return sum * APSL_GRADIENT_UNIT;
}

#endif
