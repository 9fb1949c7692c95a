// SPDX-License-Identifier: MIT
// Entries of the scaled matrix. `shared` says how two triangles meet: two bits for each corner of the first, holding
// the matching corner of the second, 3 where there is none (apsl::CsrPattern::shared).
#ifndef APSLK_MATRIX_ENTRIES_H
#define APSLK_MATRIX_ENTRIES_H

#include "layout.h"

#define APSLK_CONSISTENT 0
#define APSLK_PRINTED 1
#ifndef APSLK_MATRIX
#define APSLK_MATRIX APSLK_CONSISTENT
#endif

APSLK_INLINE uint matching_corner(uint shared, uint k) {
    return (shared >> (2u * k)) & 3u;
}

APSLK_INLINE float4 gradient_at(__global const apslk_gradients* gradients, uint a, uint corner) {
    return corner_gradient(gradients, 4u * a + corner) * APSLK_GRADIENT_UNIT;
}

#if APSLK_MATRIX == APSLK_CONSISTENT
// ½ Σ_{i ∈ a∩c} w_i g_{a,i} · g_{c,i}, scaled: Σ ḡ_{a,i} · ḡ_{c,i}.
APSLK_INLINE float off_diagonal_entry(__global const uint* triangles, __global const float4* moved,
                                      __global const apslk_gradients* gradients, uint a, uint c, uint shared) {
    (void)triangles;
    (void)moved;
    float sum = 0.0f;
    for (uint k = 0; k < 3; ++k) {
        const uint m = matching_corner(shared, k);
        if (m != 3u) sum += dot3(gradient_at(gradients, a, k), gradient_at(gradients, c, m));
    }
    return sum;
}
#else
APSLK_INLINE float4 unit_normal(__global const uint* triangles, __global const float4* moved, uint a) {
    const uint3 v = vload3(a, triangles);
    float4 n = cross(moved[v.y] - moved[v.x], moved[v.z] - moved[v.x]);
    n.w = 0.0f;
    const float length_of_n = sqrt(dot3(n, n));
    return length_of_n > 0.0f ? n / length_of_n : (float4)(0.0f);
}

// Eq. (4): ½ √(w w') (n_a·n_c) |e|² over shared edges, with the inverse masses of the two vertices opposite the edge.
// Scaled that is (n_a·n_c) |ḡ_a| |ḡ_c|.
APSLK_INLINE float off_diagonal_entry(__global const uint* triangles, __global const float4* moved,
                                      __global const apslk_gradients* gradients, uint a, uint c, uint shared) {
    float sum = 0.0f;
    for (uint k = 0; k < 3; ++k) {
        const uint m = matching_corner(shared, k);
        if (m != 3u) {
            const float4 ga = gradient_at(gradients, a, k), gc = gradient_at(gradients, c, m);
            sum += sqrt(dot3(ga, ga) * dot3(gc, gc));
        }
    }
    return sum * dot3(unit_normal(triangles, moved, a), unit_normal(triangles, moved, c));
}
#endif

// Σ |ḡ|² + (α − 1)/α: 1 up to rounding, and (α − 1)/α where nothing moves the triangle.
APSLK_INLINE float diagonal_entry(__global const apslk_gradients* gradients, uint a) {
    float sum = gradients[a].shift;
    for (uint k = 0; k < 3; ++k) {
        const float4 g = gradient_at(gradients, a, k);
        sum += dot3(g, g);
    }
    return sum;
}

APSLK_INLINE float matrix_entry(__global const uint* triangles, __global const float4* moved,
                                __global const apslk_gradients* gradients, uint row, uint column, uint shared) {
    return column == row ? diagonal_entry(gradients, row)
                         : off_diagonal_entry(triangles, moved, gradients, row, column, shared);
}

#endif
