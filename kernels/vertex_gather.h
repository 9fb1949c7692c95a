// SPDX-License-Identifier: MIT
// What a vertex receives from the triangles around it: a gather over its corners in a fixed order, since OpenCL 1.2 has
// no float atomics and a gather repeats exactly.
#ifndef APSLK_VERTEX_GATHER_H
#define APSLK_VERTEX_GATHER_H

#include "gradients.h"
#include "layout.h"

typedef struct {
    float4 force;     // Σ_{a∋i} y_a ḡ_{a,i}; w is zero
    float stiffness;  // K_i w_i = Σ_{a∋i} max(y_a, 0) √(α D_a) / A_a |ḡ_{a,i}|²: geometric stiffness over mass
} apslk_corner_sums;

// Reference: apsl::reference::geometric_stiffness. With λ = y/√(α D) and ḡ = √(w/2) g/√(α D), λ |g|²/(2A) is
// y √(α D)/A |ḡ|²/w.
APSLK_INLINE apslk_corner_sums sums_over_corners(__global const uint* corner_offsets, __global const uint* corners,
                                                 __global const apslk_gradients* gradients,
                                                 __global const float* pressure, uint i) {
    apslk_corner_sums sums;
    sums.force = (float4)(0.0f);
    float4 squares = (float4)(0.0f);  // by component: the sum over them is one, at the end
    const uint end = corner_offsets[i + 1];
    for (uint n = corner_offsets[i]; n < end; ++n) {
        const uint corner = corners[n], a = APSLK_CORNER_TRIANGLE(corner);
        const float4 g = corner_gradient(gradients, corner);
        const float y = pressure[a];
        sums.force += y * g;
        squares += fmax(y, 0.0f) * gradients[a].stiffening * (g * g);
    }
    sums.force *= APSLK_GRADIENT_UNIT;
    sums.stiffness = (APSLK_GRADIENT_UNIT * APSLK_GRADIENT_UNIT) * (squares.x + squares.y + squares.z);
    return sums;
}

// The tension's K_i w'_i, w' the effective inverse mass: of both rows of the triangles around i, with y_a − ρ_a z_a for
// an area's multiplier and the stretch row as it is before it is made orthogonal, ḡ_z = d̄ + ρ ḡ. Never below 0.
// Reference: apsl::reference, stretch_limiting.
APSLK_INLINE apslk_corner_sums sums_over_corners_of_rows(__global const uint* corner_offsets,
                                                         __global const uint* corners,
                                                         __global const apslk_gradients* gradients,
                                                         __global const float* pressure, uint run, uint i) {
    apslk_corner_sums sums;
    sums.force = (float4)(0.0f);
    float4 squares = (float4)(0.0f);
    const uint end = corner_offsets[i + 1];
    for (uint n = corner_offsets[i]; n < end; ++n) {
        const uint corner = corners[n], a = APSLK_CORNER_TRIANGLE(corner);
        const float4 g = corner_gradient(gradients, corner);
        float y = pressure[a];
        sums.force += y * g;
        if (has_stretch_row(gradients, a)) {
            const float z = pressure[run + a], share = gradients[run + a].shift;
            const float4 d = corner_gradient(gradients + run, corner), plain = d + share * g;
            sums.force += z * d;
            squares += z * gradients[run + a].stiffening * (plain * plain);
            y -= share * z;
        }
        squares += y * gradients[a].stiffening * (g * g);
    }
    sums.force *= APSLK_GRADIENT_UNIT;
    sums.stiffness = (APSLK_GRADIENT_UNIT * APSLK_GRADIENT_UNIT) * fmax(squares.x + squares.y + squares.z, 0.0f);
    return sums;
}

// Σ_{a∋i} values_a ḡ_{a,i}, of both rows; w is zero. A multiplier of a stretch row below 0 counts as 0.
APSLK_INLINE float4 sum_over_corners_of_rows(__global const uint* corner_offsets, __global const uint* corners,
                                             __global const apslk_gradients* gradients, __global const float* values,
                                             uint run, uint i) {
    float4 sum = (float4)(0.0f);
    const uint end = corner_offsets[i + 1];
    for (uint n = corner_offsets[i]; n < end; ++n) {
        const uint corner = corners[n], a = APSLK_CORNER_TRIANGLE(corner);
        sum += values[a] * corner_gradient(gradients, corner);
        if (has_stretch_row(gradients, a))
            sum += fmax(values[run + a], 0.0f) * corner_gradient(gradients + run, corner);
    }
    return sum * APSLK_GRADIENT_UNIT;
}

// Σ_{a∋i} values_a ḡ_{a,i}; w is zero.
APSLK_INLINE float4 sum_over_corners(__global const uint* corner_offsets, __global const uint* corners,
                                     __global const apslk_gradients* gradients, __global const float* values, uint i) {
    float4 sum = (float4)(0.0f);
    const uint end = corner_offsets[i + 1];
    for (uint n = corner_offsets[i]; n < end; ++n) {
        const uint corner = corners[n];
        sum += values[APSLK_CORNER_TRIANGLE(corner)] * corner_gradient(gradients, corner);
    }
    return sum * APSLK_GRADIENT_UNIT;
}

#endif
