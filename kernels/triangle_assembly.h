// SPDX-License-Identifier: MIT
// What a solve needs of the geometry of its triangles, computed APSLK_LANES triangles at a time.
// Reference: apsl::reference, geometry, and the diagonal of Eq. (3).
#ifndef APSLK_TRIANGLE_ASSEMBLY_H
#define APSLK_TRIANGLE_ASSEMBLY_H

#include "area_sums.h"
#include "gradients.h"
#include "layout.h"
#include "regularization.h"
#include "small_steps.h"
#include "triangle_geometry.h"
#include "work_group.h"

// 1: systems are solved by a polynomial that the bound of the matrix is made for.
#ifndef APSLK_CHEBYSHEV
#define APSLK_CHEBYSHEV 0
#endif

// s = 1/√(α D); 0 where nothing can move the triangle, which makes its pressure 0 by definition.
APSLK_INLINE lanes jacobi_scale(lanes scaled_diagonal, lanes rest_area) {
    const lanes scale = select((lanes)(0.0f), 1.0f / sqrt(scaled_diagonal), scaled_diagonal > 0.0f);
    return select((lanes)(0.0f), scale, rest_area > 0.0f);
}

// Two words of 16-bit fixed point: x and y, z and zero.
APSLK_INLINE void pack_gradient(apslk_triangle_geometry t, uint corner, lanes scale, lanes_int* words) {
    const lanes4 g = cross_product(t.normal, t.edge[corner]);
    const lanes factor = 32767.0f * scale * sqrt(0.5f * t.inverse_mass[corner]);
    const lanes_int x = to_int(rint(factor * g.x)), y = to_int(rint(factor * g.y)), z = to_int(rint(factor * g.z));
    words[0] = (x & 0xffff) | (y << 16);
    words[1] = z & 0xffff;
}

// The caller's values in the limiter's order. The padding keeps what it was made with: no rest area.
APSLK_INLINE void order_values(apslk_cloth cloth, bool active, __global const uint* triangle_order,
                               __global float* ordered_rest_areas, __global float* ordered_scaling,
                               __global const float* rest_areas, __global const float* regularization) {
    const apslk_range range = share_of(cloth.triangle_count, active);
    for (uint t = range.first; t < range.end; t += APSLK_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + t;
        float rest_area = rest_areas[triangle_order[a]];
#if APSLK_REGULARIZATION_PER_TRIANGLE
        const float alpha = regularization[triangle_order[a]];
        ordered_scaling[a] = fmax(alpha, 1.0f);
        if (!isfinite(alpha)) rest_area = NAN;  // one witness for both
#else
        (void)ordered_scaling;
        (void)regularization;
#endif
        ordered_rest_areas[a] = rest_area;
    }
}

// B_a = Σ_{i∈a} s_i ½ w_i |g_{a,i}|². Reference: apsl::reference::diagonal_bound. Written out: where LLVM unrolls it as
// a loop, it leaves an intrinsic that Oclgrind does not have.
APSLK_INLINE lanes bounded_diagonal(apslk_triangle_geometry t, __global const uint* triangles,
                                    __global const float* vertex_bounds, uint first) {
    const lanes s0 = load_corner_values(triangles, vertex_bounds, first, 0);
    const lanes s1 = load_corner_values(triangles, vertex_bounds, first, 1);
    const lanes s2 = load_corner_values(triangles, vertex_bounds, first, 2);
    return 0.5f *
           (s0 * t.inverse_mass[0] * squared_length(t.edge[0]) + s1 * t.inverse_mass[1] * squared_length(t.edge[1]) +
            s2 * t.inverse_mass[2] * squared_length(t.edge[2]));
}

typedef struct {
    apslk_area_sums areas;
    lanes squares, scaled_squares;  // of the right-hand side, plain and scaled
} apslk_assembly_sums;

// gradients[a], residual[a] = s b, scaled_diagonal[a] = α D. b = A − A⁰, in small steps less the share `error_left` of
// `start_errors`. `alpha` holds for all triangles, unless `regularization` has one for each. Both come from
// order_values. For a Chebyshev solve `regularization` holds s_i of the vertices, B takes the place of α D, and there
// is no damping.
APSLK_INLINE apslk_assembly_sums assemble_triangles(apslk_cloth cloth, bool active, float alpha, float damping,
                                                    float adaptive_factor, __global const uint* triangles,
                                                    __global const float4* moved, __global apslk_gradients* gradients,
                                                    __global float* residual, __global float* scaled_diagonal,
                                                    __global const float* rest_areas,
                                                    __global const float* regularization, bool in_small_steps,
                                                    float error_left, __global const float* start_errors) {
    const apslk_range range = share_of(blocks_of(cloth), active);
    apslk_assembly_sums sums;
    sums.areas = no_areas();
    sums.squares = 0.0f;
    sums.scaled_squares = 0.0f;
    for (uint block = range.first; block < range.end; block += APSLK_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + block * APSLK_LANES;
        const apslk_triangle_geometry triangle = load_triangles(triangles, moved, a);
        const lanes rest_area = load_lanes(rest_areas, a);
        lanes excess = triangle.area - rest_area;
        if (in_small_steps) {  // uniform
            if (error_left > 0.0f) excess -= error_left * load_lanes(start_errors, a);
            const lanes least = (1.0f - APSLK_GREATEST_GROWTH) * triangle.area;
            excess = select(excess, least, excess < least);  // a NaN stays
        }
#if APSLK_CHEBYSHEV
        (void)alpha;
        (void)damping;
        (void)adaptive_factor;
        const lanes damped = APSLK_BOUND_MARGIN * bounded_diagonal(triangle, triangles, regularization, a),
                    shift = 0.0f;
#else
#if APSLK_REGULARIZATION_PER_TRIANGLE
        (void)alpha;
        const lanes given = load_lanes(regularization, a);
#else
        (void)regularization;
        const lanes given = alpha;
#endif
        const lanes effective = effective_regularization(given, damping, adaptive_factor);
        const lanes shift = (effective - 1.0f) / effective, damped = effective * triangle.diagonal;
#endif
        const lanes scale = jacobi_scale(damped, rest_area);
        const lanes stretch = select((lanes)(0.0f), excess, scale > 0.0f);
        const lanes r = scale * stretch;

        lanes_int words[8];
        pack_gradient(triangle, 0, scale, words);
        pack_gradient(triangle, 1, scale, words + 2);
        pack_gradient(triangle, 2, scale, words + 4);
        words[6] = bits_of(shift);
        words[7] = bits_of(select((lanes)(0.0f), 1.0f / (scale * triangle.area), scale * triangle.area > 0.0f));
        store_records(words, (__global int4*)gradients, a);
        store_lanes(r, residual, a);
        store_lanes(damped, scaled_diagonal, a);
        sums.squares += stretch * stretch;
        sums.scaled_squares += r * r;
        add_areas(&sums.areas, triangle, rest_area);
    }
    return sums;
}

// start_errors[a] = A − A⁰ at the start of the step, whose vertices are in `start`; 0 where there is no rest area.
// Returns how many of this work-item's are not finite.
APSLK_INLINE lanes find_start_errors(apslk_cloth cloth, bool active, __global const uint* triangles,
                                     __global const float4* start, __global const float* rest_areas,
                                     __global float* start_errors) {
    const apslk_range range = share_of(blocks_of(cloth), active);
    lanes not_finite = 0.0f;
    for (uint block = range.first; block < range.end; block += APSLK_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + block * APSLK_LANES;
        const lanes area = load_triangles(triangles, start, a).area, rest_area = load_lanes(rest_areas, a);
        const lanes error = select((lanes)(0.0f), area - rest_area, rest_area > 0.0f);
        store_lanes(error, start_errors, a);
        not_finite += select((lanes)(1.0f), (lanes)(0.0f), fabs(error) < INFINITY);
    }
    return not_finite;
}

// The areas alone.
APSLK_INLINE apslk_area_sums measure_triangles(apslk_cloth cloth, bool active, __global const uint* triangles,
                                               __global const float4* moved, __global const float* rest_areas) {
    const apslk_range range = share_of(blocks_of(cloth), active);
    apslk_area_sums sums = no_areas();
    for (uint block = range.first; block < range.end; block += APSLK_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + block * APSLK_LANES;
        add_areas(&sums, load_triangles(triangles, moved, a), load_lanes(rest_areas, a));
    }
    return sums;
}

#endif
