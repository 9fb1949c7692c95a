// SPDX-License-Identifier: MIT
// What a solve needs of the geometry of its triangles, computed APSLK_LANES triangles at a time.
// Reference: apsl::reference, geometry, and the diagonal of Eq. (3).
#ifndef APSLK_TRIANGLE_ASSEMBLY_H
#define APSLK_TRIANGLE_ASSEMBLY_H

#include "area_sums.h"
#include "gradients.h"
#include "layout.h"
#include "limits_stretch.h"
#include "regularization.h"
#include "small_steps.h"
#include "stretch_rows.h"
#include "triangle_geometry.h"
#include "work_group.h"

// 1: systems are solved by a polynomial that the bound of the matrix is made for.
#ifndef APSLK_CHEBYSHEV
#define APSLK_CHEBYSHEV 0
#endif

// 1: each triangle has a ceiling of its own.
#ifndef APSLK_STRETCH_CEILING_PER_TRIANGLE
#define APSLK_STRETCH_CEILING_PER_TRIANGLE 0
#endif

#define APSLK_MARGIN (APSLK_LIMITS_STRETCH ? APSLK_ROWS_BOUND_MARGIN : APSLK_BOUND_MARGIN)

// s = 1/√(α D); 0 where nothing can move the triangle, which makes its pressure 0 by definition.
APSLK_INLINE lanes jacobi_scale(lanes scaled_diagonal, lanes rest_area) {
    const lanes scale = select((lanes)(0.0f), 1.0f / sqrt(scaled_diagonal), scaled_diagonal > 0.0f);
    return select((lanes)(0.0f), scale, rest_area > 0.0f);
}

// Two words of 16-bit fixed point: x and y, z and zero.
APSLK_INLINE void pack_gradient(lanes4 g, lanes inverse_mass, lanes scale, lanes_int* words) {
    const lanes factor = 32767.0f * scale * sqrt(0.5f * inverse_mass);
    const lanes_int x = to_int(rint(factor * g.x)), y = to_int(rint(factor * g.y)), z = to_int(rint(factor * g.z));
    words[0] = (x & 0xffff) | (y << 16);
    words[1] = z & 0xffff;
}

// The caller's values in the limiter's order. The padding keeps what it was made with: no rest area.
APSLK_INLINE void order_values(apslk_cloth cloth, bool active, __global const uint* triangle_order,
                               __global float* ordered_rest, __global float* ordered_scaling,
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
        ordered_rest[a] = rest_area;
    }
}

// The caller's rest shapes, turned about in their planes so that three numbers hold each, and ceilings likewise.
// `stretch_ceilings` has one for each triangle, where there are such; otherwise `ceiling` is that of all.
APSLK_INLINE void order_rest_shapes(apslk_cloth cloth, bool active, float ceiling, __global const uint* triangle_order,
                                    __global float* ordered_rest, __global const float* rest_shapes,
                                    __global const float* stretch_ceilings) {
    const apslk_range range = share_of(cloth.triangle_count, active);
    for (uint t = range.first; t < range.end; t += APSLK_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + t;
        const float4 m = vload4(triangle_order[a], rest_shapes);
#if APSLK_STRETCH_CEILING_PER_TRIANGLE
        ceiling = stretch_ceilings[triangle_order[a]];
        if (ceiling != 0.0f && ceiling < APSLK_LEAST_STRETCH_CEILING) ceiling = APSLK_LEAST_STRETCH_CEILING;
#else
        (void)stretch_ceilings;
#endif
        if (!all(isfinite(m)) || !isfinite(ceiling)) ordered_rest[a] = NAN;  // one witness for all
        const float m11 = length(m.zw), determinant = m.x * m.w - m.y * m.z;
        const bool has_shape = ordered_rest[a] > 0.0f && determinant != 0.0f;
        ordered_rest[APSLK_REST_SHAPE_00 * cloth.run + a] = has_shape ? determinant / m11 : 0.0f;
        ordered_rest[APSLK_REST_SHAPE_01 * cloth.run + a] = has_shape ? (m.x * m.z + m.y * m.w) / m11 : 0.0f;
        ordered_rest[APSLK_REST_SHAPE_11 * cloth.run + a] = has_shape ? m11 : 0.0f;
        ordered_rest[APSLK_CEILING * cloth.run + a] = has_shape ? ceiling : 0.0f;
    }
}

// B_a = Σ_{i∈a} s_i ½ w_i |g_{a,i}|² of rows with these gradients. Reference: apsl::reference::diagonal_bound. Written
// out: where LLVM unrolls it as a loop, it leaves an intrinsic that Oclgrind does not have.
APSLK_INLINE lanes bounded_diagonal(apslk_triangle_geometry t, lanes4 g0, lanes4 g1, lanes4 g2,
                                    __global const uint* triangles, __global const float* vertex_bounds, uint first) {
    const lanes s0 = load_corner_values(triangles, vertex_bounds, first, 0);
    const lanes s1 = load_corner_values(triangles, vertex_bounds, first, 1);
    const lanes s2 = load_corner_values(triangles, vertex_bounds, first, 2);
    return 0.5f * (s0 * t.inverse_mass[0] * squared_length(g0) + s1 * t.inverse_mass[1] * squared_length(g1) +
                   s2 * t.inverse_mass[2] * squared_length(g2));
}

typedef struct {
    lanes squares;    // of the right-hand side
    lanes take_part;  // 1, or 0
} apslk_assembled_stretches;

// The stretch rows of triangles with this `stretch`, whose area rows have `area_excess` for right-hand side and
// `area_scale`.
APSLK_INLINE apslk_assembled_stretches
assemble_stretch_rows(apslk_cloth cloth, apslk_triangle_geometry t, apslk_rest_shape shape,
                      apslk_principal_stretch stretch, lanes rest_area, lanes area_excess, lanes area_scale,
                      __global const uint* triangles, __global const float* vertex_bounds,
                      __global apslk_gradients* gradients, __global float* residual, __global float* scaled_diagonal,
                      int small_steps, bool for_solve, float asked_again, __global float* start_errors, uint a) {
    lanes ceiling = shape.ceiling;
    if (small_steps > 0) {  // uniform
        const lanes held = load_lanes(start_errors + APSLK_HELD_EXCESS * cloth.run, a);
        const lanes start = load_lanes(start_errors + APSLK_START_EXCESS * cloth.run, a);
        if (for_solve)  // uniform
            store_lanes(next_held_excess(held, stretch.value - ceiling, start, small_steps, asked_again),
                        start_errors + APSLK_HELD_EXCESS * cloth.run, a);
        ceiling += held;
    }
    const apslk_stretch_row row = stretch_row(t, shape, stretch, rest_area, area_excess, ceiling);
    const lanes bound = APSLK_MARGIN * bounded_diagonal(t, row.gradient[0], row.gradient[1], row.gradient[2], triangles,
                                                        vertex_bounds, a);
    const lanes scale = jacobi_scale(bound, rest_area);
    const lanes value = select((lanes)(0.0f), row.value, scale > 0.0f);
    apslk_assembled_stretches assembled;
    assembled.squares = value * value;
    assembled.take_part = select((lanes)(0.0f), (lanes)(1.0f), scale > 0.0f);
    if (!(max_of_lanes(assembled.take_part) > 0.0f)) return assembled;
    __global apslk_gradients* rows = gradients + cloth.run;
    lanes_int words[8];
    pack_gradient(row.gradient[0], t.inverse_mass[0], scale, words);
    pack_gradient(row.gradient[1], t.inverse_mass[1], scale, words + 2);
    pack_gradient(row.gradient[2], t.inverse_mass[2], scale, words + 4);
    words[6] = bits_of(row.share * scale * select((lanes)(0.0f), 1.0f / area_scale, area_scale > 0.0f));
    const lanes weight = scale * rest_area * stretch.value;
    words[7] = bits_of(select((lanes)(0.0f), 1.0f / weight, weight > 0.0f));
    store_records(words, (__global int4*)rows, a);
    store_lanes(scale * value, residual + cloth.run, a);
    store_lanes(bound, scaled_diagonal + cloth.run, a);
    return assembled;
}

typedef struct {
    apslk_area_sums areas;
    lanes squares, scaled_squares;  // of the right-hand side, plain and scaled
} apslk_assembly_sums;

// gradients[a], residual[a] = s b, scaled_diagonal[a] = α D. b = A − A⁰, in small steps less the share `error_left` of
// `start_errors`, where with a stretch ceiling a run of excesses that stand for now follows; those of the next
// sub-step are kept `for_solve`, not for a bound alone. `alpha` holds for all
// triangles, unless `regularization` has one for each. Both come from order_values. For a Chebyshev solve
// `regularization` holds s_i of the vertices, B takes the place of α D, and there is no damping; with a stretch ceiling
// stretch rows follow in runs of their own. `rest`: the limiter's rest values.
APSLK_INLINE apslk_assembly_sums assemble_triangles(apslk_cloth cloth, bool active, float alpha, float damping,
                                                    float adaptive_factor, __global const uint* triangles,
                                                    __global const float4* moved, __global apslk_gradients* gradients,
                                                    __global float* residual, __global float* scaled_diagonal,
                                                    __global const float* rest, __global const float* regularization,
                                                    int small_steps, float error_left, bool for_solve,
                                                    float asked_again, __global float* start_errors) {
    const apslk_range range = share_of(blocks_of(cloth), active);
    apslk_assembly_sums sums;
    sums.areas = no_areas();
    sums.squares = 0.0f;
    sums.scaled_squares = 0.0f;
    for (uint block = range.first; block < range.end; block += APSLK_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + block * APSLK_LANES;
        const apslk_triangle_geometry triangle = load_triangles(triangles, moved, a);
        const lanes rest_area = load_lanes(rest, a);
        lanes excess = triangle.area - rest_area;
        if (small_steps > 0) {  // uniform
            if (error_left > 0.0f) excess -= error_left * load_lanes(start_errors, a);
            const lanes least = (1.0f - APSLK_GREATEST_GROWTH) * triangle.area;
            excess = select(excess, least, excess < least);  // a NaN stays
        }
#if APSLK_CHEBYSHEV
        (void)alpha;
        (void)damping;
        (void)adaptive_factor;
        // |g| is the length of the edge.
        const lanes damped = APSLK_MARGIN * bounded_diagonal(triangle, triangle.edge[0], triangle.edge[1],
                                                             triangle.edge[2], triangles, regularization, a);
        lanes shift = 0.0f;
#else
#if APSLK_REGULARIZATION_PER_TRIANGLE
        (void)alpha;
        const lanes given = load_lanes(regularization, a);
#else
        (void)regularization;
        const lanes given = alpha;
#endif
        const lanes effective = effective_regularization(given, damping, adaptive_factor);
        const lanes damped = effective * triangle.diagonal;
        lanes shift = (effective - 1.0f) / effective;
#endif
        const lanes scale = jacobi_scale(damped, rest_area);
#if APSLK_LIMITS_STRETCH
        excess = asked_of_area_row(triangle, rest_area, excess);
#endif
        const lanes area_excess = select((lanes)(0.0f), excess, scale > 0.0f);
        const lanes r = scale * area_excess;

#if APSLK_LIMITS_STRETCH
        const apslk_rest_shape shape = load_rest_shape(cloth, rest, a);
        const apslk_principal_stretch stretch = principal_stretch(triangle, shape);
        const apslk_assembled_stretches stretches = assemble_stretch_rows(
            cloth, triangle, shape, stretch, rest_area, area_excess, scale, triangles, regularization, gradients,
            residual, scaled_diagonal, small_steps, for_solve, asked_again, start_errors, a);
        shift = stretches.take_part;
        sums.squares += stretches.squares;
        add_stretches(&sums.areas, rest_area, shape, stretch.value);
#else
        (void)for_solve;
        (void)asked_again;
#endif
        lanes_int words[8];
        pack_gradient(cross_product(triangle.normal, triangle.edge[0]), triangle.inverse_mass[0], scale, words);
        pack_gradient(cross_product(triangle.normal, triangle.edge[1]), triangle.inverse_mass[1], scale, words + 2);
        pack_gradient(cross_product(triangle.normal, triangle.edge[2]), triangle.inverse_mass[2], scale, words + 4);
        words[6] = bits_of(shift);
        words[7] = bits_of(select((lanes)(0.0f), 1.0f / (scale * triangle.area), scale * triangle.area > 0.0f));
        store_records(words, (__global int4*)gradients, a);
        store_lanes(r, residual, a);
        store_lanes(damped, scaled_diagonal, a);
        sums.squares += area_excess * area_excess;
        sums.scaled_squares += r * r;
        add_areas(&sums.areas, triangle, rest_area);
    }
    return sums;
}

// start_errors[a] = A − A⁰ at the start of the step, whose vertices are in `start`, and with a stretch ceiling in runs
// of their own the excess over it, as it was and as it is held; 0 where there is no rest area. Returns how many of this
// work-item's are not finite.
APSLK_INLINE lanes find_start_errors(apslk_cloth cloth, bool active, __global const uint* triangles,
                                     __global const float4* start, __global const float* rest,
                                     __global float* start_errors) {
    const apslk_range range = share_of(blocks_of(cloth), active);
    lanes not_finite = 0.0f;
    for (uint block = range.first; block < range.end; block += APSLK_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + block * APSLK_LANES;
        const apslk_triangle_geometry triangle = load_triangles(triangles, start, a);
        const lanes rest_area = load_lanes(rest, a);
        const lanes error = select((lanes)(0.0f), triangle.area - rest_area, rest_area > 0.0f);
        store_lanes(error, start_errors, a);
#if APSLK_LIMITS_STRETCH
        const apslk_rest_shape shape = load_rest_shape(cloth, rest, a);
        const lanes excess = stretch_excess(principal_stretch(triangle, shape).value, shape.ceiling);
        store_lanes(excess, start_errors + APSLK_START_EXCESS * cloth.run, a);
        store_lanes(excess, start_errors + APSLK_HELD_EXCESS * cloth.run, a);
#endif
        not_finite += select((lanes)(1.0f), (lanes)(0.0f), fabs(error) < INFINITY);
    }
    return not_finite;
}

// Areas and stretches alone.
APSLK_INLINE apslk_area_sums measure_triangles(apslk_cloth cloth, bool active, __global const uint* triangles,
                                               __global const float4* moved, __global const float* rest) {
    const apslk_range range = share_of(blocks_of(cloth), active);
    apslk_area_sums sums = no_areas();
    for (uint block = range.first; block < range.end; block += APSLK_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + block * APSLK_LANES;
        const apslk_triangle_geometry triangle = load_triangles(triangles, moved, a);
        const lanes rest_area = load_lanes(rest, a);
        add_areas(&sums, triangle, rest_area);
#if APSLK_LIMITS_STRETCH
        const apslk_rest_shape shape = load_rest_shape(cloth, rest, a);
        add_stretches(&sums, rest_area, shape, principal_stretch(triangle, shape).value);
#endif
    }
    return sums;
}

#endif
