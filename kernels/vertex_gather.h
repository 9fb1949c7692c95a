// SPDX-License-Identifier: MIT
// What a vertex receives from the triangles around it: a gather over its corners in a fixed order, since OpenCL 1.2 has
// no float atomics and a gather repeats exactly.
#ifndef APSL_VERTEX_GATHER_H
#define APSL_VERTEX_GATHER_H

#include "gradients.h"
#include "layout.h"

// Σ_{a∋i} values_a ĝ_{a,i}; w is zero.
static inline __attribute__((always_inline)) float4 sum_over_corners(__global const uint* corner_offsets,
                                                                     __global const uint* corners,
                                                                     __global const apsl_gradients* gradients,
                                                                     __global const float* values, uint i) {
    float4 sum = (float4)(0.0f);
    const uint end = corner_offsets[i + 1];
    for (uint n = corner_offsets[i]; n < end; ++n) {
        const uint corner = corners[n];
        const uint a = APSL_CORNER_TRIANGLE(corner);
        sum += values[a] * corner_gradient(gradients[a], APSL_CORNER_NUMBER(corner));
    }
    return sum;
}

#endif
