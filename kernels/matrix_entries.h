// SPDX-License-Identifier: MIT
// Entries of the scaled matrix, from scaled gradients. `shared` says how two triangles meet: two bits for each corner
// of the first, holding the matching corner of the second, 3 where there is none (apsl::CsrPattern::shared).
#ifndef APSL_MATRIX_ENTRIES_H
#define APSL_MATRIX_ENTRIES_H

#include "gradients.h"

#define APSL_CONSISTENT 0
#define APSL_PRINTED 1
#ifndef APSL_MATRIX
#define APSL_MATRIX APSL_CONSISTENT
#endif

#if APSL_MATRIX == APSL_CONSISTENT
// ½ Σ_{i ∈ a∩c} w_i ĝ_{a,i} · ĝ_{c,i}; w holds the inverse masses of a's corners.
static inline __attribute__((always_inline)) float off_diagonal_entry(apsl_gradients ga, apsl_gradients gc, float4 w,
                                                                      uint shared, float4 opposite_w) {
    (void)opposite_w;
    const float weight[3] = {w.x, w.y, w.z};
    float sum = 0.0f;
    for (uint k = 0; k < 3; ++k) {
        const uint m = (shared >> (2u * k)) & 3u;
        if (m != 3u) sum += weight[k] * dot3(corner_gradient(ga, k), corner_gradient(gc, m));
    }
    return 0.5f * sum;
}
#else
// g_0 × g_1 = 2A n, and scaling by s > 0 keeps the direction.
static inline __attribute__((always_inline)) float4 unit_normal(apsl_gradients g) {
    const float4 n = cross((float4)(g.g0_shift.xyz, 0.0f), (float4)(g.g1_scale.xyz, 0.0f));
    const float length_of_n = sqrt(dot3(n, n));
    return length_of_n > 0.0f ? n / length_of_n : (float4)(0.0f);
}

// Eq. (4): ½ √(w w') (n_a·n_c) |e|² over shared edges, with the inverse masses of the two vertices opposite the edge;
// |e|² comes scaled as |ĝ_a| |ĝ_c|. opposite_w holds the inverse masses of c's corners.
static inline __attribute__((always_inline)) float off_diagonal_entry(apsl_gradients ga, apsl_gradients gc, float4 w,
                                                                      uint shared, float4 opposite_w) {
    const float weight[3] = {w.x, w.y, w.z};
    const float opposite_weight[3] = {opposite_w.x, opposite_w.y, opposite_w.z};
    float sum = 0.0f;
    for (uint k = 0; k < 3; ++k) {
        const uint m = (shared >> (2u * k)) & 3u;
        if (m != 3u) {
            const float4 gk = corner_gradient(ga, k);
            const float4 gm = corner_gradient(gc, m);
            sum += sqrt(weight[k] * opposite_weight[m]) * sqrt(dot3(gk, gk)) * sqrt(dot3(gm, gm));
        }
    }
    return 0.5f * sum * dot3(unit_normal(ga), unit_normal(gc));
}
#endif

// ½ Σ w |ĝ|² + (α − 1)/α: 1 up to rounding, and (α − 1)/α where nothing moves the triangle.
static inline __attribute__((always_inline)) float diagonal_entry(apsl_gradients g, float4 w) {
    const float4 g0 = corner_gradient(g, 0), g1 = corner_gradient(g, 1), g2 = corner_gradient(g, 2);
    return 0.5f * (w.x * dot3(g0, g0) + w.y * dot3(g1, g1) + w.z * dot3(g2, g2)) + g.g0_shift.w;
}

static inline __attribute__((always_inline)) float4 corner_inverse_masses(__global const uint* triangles,
                                                                          __global const float4* predicted, uint a) {
    const uint3 v = vload3(a, triangles);
    return (float4)(predicted[v.x].w, predicted[v.y].w, predicted[v.z].w, 0.0f);
}

// One entry of row a, whose own gradients and inverse masses are at hand.
static inline __attribute__((always_inline)) float matrix_entry(__global const uint* triangles,
                                                                __global const float4* predicted,
                                                                __global const apsl_gradients* gradients, uint a,
                                                                apsl_gradients ga, float4 wa, uint column,
                                                                uint shared) {
    if (column == a) return diagonal_entry(ga, wa);
#if APSL_MATRIX == APSL_PRINTED
    const float4 wc = corner_inverse_masses(triangles, predicted, column);
#else
    (void)triangles;
    (void)predicted;
    const float4 wc = wa;
#endif
    return off_diagonal_entry(ga, gradients[column], wa, shared, wc);
}

#endif
