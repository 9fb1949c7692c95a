// SPDX-License-Identifier: MIT
// What a solve needs of the geometry of its triangles, computed APSL_LANES triangles at a time.
// Reference: apsl::reference, geometry, and the diagonal of Eq. (3).
#ifndef APSL_TRIANGLE_ASSEMBLY_H
#define APSL_TRIANGLE_ASSEMBLY_H

#include "area_sums.h"
#include "gradients.h"
#include "layout.h"
#include "regularization.h"
#include "triangle_geometry.h"
#include "work_group.h"

// 1: systems are solved by a polynomial that the bound of the matrix is made for.
#ifndef APSL_CHEBYSHEV
#define APSL_CHEBYSHEV 0
#endif

// s = 1/√(α D); 0 where nothing can move the triangle, which makes its pressure 0 by definition.
APSL_INLINE lanes jacobi_scale(lanes damped_diagonal, lanes rest_area) {
    const lanes scale = select((lanes)(0.0f), 1.0f / sqrt(damped_diagonal), damped_diagonal > 0.0f);
    return select((lanes)(0.0f), scale, rest_area > 0.0f);
}

// Two words of 16-bit fixed point: x and y, z and zero.
APSL_INLINE void pack_gradient(apsl_triangle_geometry t, uint corner, lanes scale, lanes_int* words) {
    const lanes4 g = cross_product(t.normal, t.edge[corner]);
    const lanes factor = 32767.0f * scale * sqrt(0.5f * t.inverse_mass[corner]);
    const lanes_int x = to_int(rint(factor * g.x)), y = to_int(rint(factor * g.y)), z = to_int(rint(factor * g.z));
    words[0] = (x & 0xffff) | (y << 16);
    words[1] = z & 0xffff;
}

// The caller's values in the limiter's order. The padding keeps what it was made with: no rest area.
APSL_INLINE void order_values(apsl_cloth cloth, bool active, __global const uint* triangle_order,
                              __global float* ordered_rest_areas, __global float* ordered_regularization,
                              __global const float* rest_areas, __global const float* regularization) {
    const apsl_range range = share_of(cloth.triangle_count, active);
    for (uint t = range.first; t < range.end; t += APSL_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + t;
        float rest_area = rest_areas[triangle_order[a]];
#if APSL_REGULARIZATION_PER_TRIANGLE
        const float alpha = regularization[triangle_order[a]];
        ordered_regularization[a] = fmax(alpha, 1.0f);
        if (!isfinite(alpha)) rest_area = NAN;  // one witness for both
#else
        (void)ordered_regularization;
        (void)regularization;
#endif
        ordered_rest_areas[a] = rest_area;
    }
}

typedef struct {
    apsl_area_sums areas;
    lanes squares, scaled_squares;  // of the right-hand side, plain and scaled
} apsl_assembly_sums;

// gradients[a], residual[a] = s (A − A⁰), damped_diagonal[a] = α D. `alpha` holds for all triangles, unless
// `regularization` has one for each. Both come from order_values. For a Chebyshev solve `regularization` holds ρ, the
// bound of the matrix over D, which takes the place of α in the scaling, and there is no damping.
APSL_INLINE apsl_assembly_sums assemble_triangles(apsl_cloth cloth, bool active, float alpha, float damping,
                                                  float adaptive_factor, __global const uint* triangles,
                                                  __global const float4* predicted, __global apsl_gradients* gradients,
                                                  __global float* residual, __global float* damped_diagonal,
                                                  __global const float* rest_areas,
                                                  __global const float* regularization) {
    const apsl_range range = share_of(blocks_of(cloth), active);
    apsl_assembly_sums sums;
    sums.areas = no_areas();
    sums.squares = 0.0f;
    sums.scaled_squares = 0.0f;
    for (uint block = range.first; block < range.end; block += APSL_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + block * APSL_LANES;
        const apsl_triangle_geometry triangle = load_triangles(triangles, predicted, a);
        const lanes rest_area = load_lanes(rest_areas, a);
#if APSL_CHEBYSHEV
        (void)alpha;
        (void)damping;
        (void)adaptive_factor;
        const lanes effective = load_lanes(regularization, a), shift = 0.0f;
#else
#if APSL_REGULARIZATION_PER_TRIANGLE
        (void)alpha;
        const lanes given = load_lanes(regularization, a);
#else
        (void)regularization;
        const lanes given = alpha;
#endif
        const lanes effective = effective_regularization(given, damping, adaptive_factor);
        const lanes shift = (effective - 1.0f) / effective;
#endif
        const lanes damped = effective * triangle.diagonal;
        const lanes scale = jacobi_scale(damped, rest_area);
        const lanes stretch = select((lanes)(0.0f), triangle.area - rest_area, scale > 0.0f);
        const lanes r = scale * stretch;

        lanes_int words[8];
        pack_gradient(triangle, 0, scale, words);
        pack_gradient(triangle, 1, scale, words + 2);
        pack_gradient(triangle, 2, scale, words + 4);
        words[6] = bits_of(shift);
        words[7] = 0;
        store_records(words, (__global int4*)gradients, a);
        store_lanes(r, residual, a);
        store_lanes(damped, damped_diagonal, a);
        sums.squares += stretch * stretch;
        sums.scaled_squares += r * r;
        add_areas(&sums.areas, triangle, rest_area);
    }
    return sums;
}

// The areas alone.
APSL_INLINE apsl_area_sums measure_triangles(apsl_cloth cloth, bool active, __global const uint* triangles,
                                             __global const float4* predicted, __global const float* rest_areas) {
    const apsl_range range = share_of(blocks_of(cloth), active);
    apsl_area_sums sums = no_areas();
    for (uint block = range.first; block < range.end; block += APSL_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + block * APSL_LANES;
        add_areas(&sums, load_triangles(triangles, predicted, a), load_lanes(rest_areas, a));
    }
    return sums;
}

#endif
