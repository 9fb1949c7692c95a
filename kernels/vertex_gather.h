// SPDX-License-Identifier: MIT
// What a vertex receives from the triangles around it: a gather over its corners in a fixed order, since OpenCL 1.2 has
// no float atomics and a gather repeats exactly.
#ifndef APSLK_VERTEX_GATHER_H
#define APSLK_VERTEX_GATHER_H

#include "gradients.h"
#include "layout.h"
#include "limits_stretch.h"

typedef struct {
    float4 force;  // Σ_{a∋i} y_a ḡ_{a,i}; w is zero
    // K_i w_i, geometric stiffness over mass, never below 0: Σ_{a∋i} max(y_a, 0) √(α D_a) / A_a |ḡ_{a,i}|². With a
    // stretch ceiling the sum over both rows, with y_a − ρ_a z_a for an area's multiplier, as it is, and the stretch
    // row before it is made orthogonal, d̄ + ρ ḡ.
    float stiffness;
} apslk_corner_sums;

// Reference: apsl::reference::geometric_stiffness, and stretch_limiting. With λ = y/√(α D) and ḡ = √(w/2) g/√(α D),
// λ |g|²/(2A) is y √(α D)/A |ḡ|²/w. `run`: of the arrays of rows.
APSLK_INLINE apslk_corner_sums sums_over_corners(__global const uint* corner_offsets, __global const uint* corners,
                                                 __global const apslk_gradients* gradients,
                                                 __global const float* pressure, uint run, uint i) {
    apslk_corner_sums sums;
    sums.force = (float4)(0.0f);
    float4 squares = (float4)(0.0f);  // by component: the sum over them is one, at the end
    const uint end = corner_offsets[i + 1];
    for (uint n = corner_offsets[i]; n < end; ++n) {
        const uint corner = corners[n], a = APSLK_CORNER_TRIANGLE(corner);
        const float4 g = corner_gradient(gradients, corner);
        const float y = pressure[a];
        sums.force += y * g;
#if APSLK_LIMITS_STRETCH
        float tension = y;
        if (has_stretch_row(gradients, a)) {
            const float z = pressure[run + a], share = gradients[run + a].shift;
            const float4 d = corner_gradient(gradients + run, corner), plain = d + share * g;
            sums.force += z * d;
            squares += z * gradients[run + a].stiffening * (plain * plain);
            tension -= share * z;
        }
#else
        (void)run;
        const float tension = fmax(y, 0.0f);
#endif
        squares += tension * gradients[a].stiffening * (g * g);
    }
    sums.force *= APSLK_GRADIENT_UNIT;
    sums.stiffness = (APSLK_GRADIENT_UNIT * APSLK_GRADIENT_UNIT) * (squares.x + squares.y + squares.z);
#if APSLK_LIMITS_STRETCH
    sums.stiffness = fmax(sums.stiffness, 0.0f);
#endif
    return sums;
}

// Σ_{a∋i} values_a ḡ_{a,i}, of both rows where there are two; w is zero. A multiplier of a stretch row below 0 counts
// as 0.
APSLK_INLINE float4 sum_over_corners(__global const uint* corner_offsets, __global const uint* corners,
                                     __global const apslk_gradients* gradients, __global const float* values, uint run,
                                     uint i) {
    float4 sum = (float4)(0.0f);
    const uint end = corner_offsets[i + 1];
    for (uint n = corner_offsets[i]; n < end; ++n) {
        const uint corner = corners[n], a = APSLK_CORNER_TRIANGLE(corner);
        sum += values[a] * corner_gradient(gradients, corner);
#if APSLK_LIMITS_STRETCH
        if (has_stretch_row(gradients, a))
            sum += fmax(values[run + a], 0.0f) * corner_gradient(gradients + run, corner);
#else
        (void)run;
#endif
    }
    return sum * APSLK_GRADIENT_UNIT;
}

#endif
