// SPDX-License-Identifier: MIT
// The scaled corner gradients of a triangle and how they are stored.
//
// g_k = n × e_k with e_k the edge opposite corner k, so ∂A/∂x_k = ½ g_k. Stored times s = 1/√(α D), D = diag(G):
// in the unknown y = λ / s the damped matrix has a diagonal of ones, and plain CG on it is Jacobi-preconditioned CG on
// G. The three gradients of a triangle sum to zero, so two are kept.
#ifndef APSL_GRADIENTS_H
#define APSL_GRADIENTS_H

// 32 bytes a triangle: scaled g_0, (α − 1)/α; scaled g_1, s.
typedef struct {
    float4 g0_shift;
    float4 g1_scale;
} apsl_gradients;

// Gradient at a corner; w is zero.
static inline __attribute__((always_inline)) float4 corner_gradient(apsl_gradients g, uint corner) {
    const float4 g0 = (float4)(g.g0_shift.xyz, 0.0f);
    const float4 g1 = (float4)(g.g1_scale.xyz, 0.0f);
    return corner == 0u ? g0 : corner == 1u ? g1 : -(g0 + g1);
}

static inline __attribute__((always_inline)) float dot3(float4 a, float4 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

#endif
