// SPDX-License-Identifier: MIT
// The scaled corner gradients of a triangle and how they are stored.
//
// g_k = n × e_k with e_k the edge opposite corner k, so ∂A/∂x_k = ½ g_k. Stored is ḡ_k = √(w_k / 2) g_k / √(α D), with
// D = diag(G): the damped matrix in the unknown y = λ √(α D) is then A = J̄ J̄ᵀ + diag((α − 1)/α), its diagonal is all
// ones, and plain CG on it is Jacobi-preconditioned CG on G.
//
// Σ_k |ḡ_k|² = 1/α ≤ 1, whatever the units of the scene, so that 16-bit fixed point holds a component to 1.5e-5.
#ifndef APSLK_GRADIENTS_H
#define APSLK_GRADIENTS_H

#include "layout.h"

// 32 bytes a triangle. Corner n's gradient is entry n of the array taken as short4, n = 4 · triangle + corner number.
// Three members, not an array of three: a checker that knows the array's length would call those indices out of bounds.
typedef struct {
    short4 corner_0, corner_1, corner_2;  // w is zero
    // (α − 1)/α. With a stretch ceiling, where there is no damping, 1 if the triangle's stretch row takes part and 0 if
    // not; then nothing reads that row. Of a stretch row the share ρ = r √(B_A/B) of its area row.
    float shift;
    float stiffening;  // √(α D) / A, m⁻¹ kg^(−1/2): see apslk_corner_sums; of a stretch row, A⁰ s₁
} apslk_gradients;

#define APSLK_GRADIENT_UNIT (1.0f / 32767.0f)

// In units of APSLK_GRADIENT_UNIT; w is zero.
APSLK_INLINE float4 corner_gradient(__global const apslk_gradients* gradients, uint corner) {
    return convert_float4(((__global const short4*)gradients)[corner]);
}

APSLK_INLINE bool has_stretch_row(__global const apslk_gradients* gradients, uint triangle) {
    return gradients[triangle].shift > 0.0f;
}

APSLK_INLINE float dot3(float4 a, float4 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

#endif
