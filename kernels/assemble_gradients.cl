// SPDX-License-Identifier: MIT
// Areas, right-hand side of Eq. (5) and scaled corner gradients: everything a solve needs of the geometry.
// Reference: apsl::reference::corner_gradients, areas, and the diagonal of Eq. (3).
// Moves 12 B indices, about 8 B positions, 4 B rest area read; 32 B gradients, 4 B residual, 4 B α D written, a
// triangle.
#include "gradients.h"
#include "layout.h"
#include "work_group.h"

#ifndef APSL_REGULARIZATION_PER_TRIANGLE
#define APSL_REGULARIZATION_PER_TRIANGLE 0
#endif

typedef struct {
    float4 e0, e1, e2;  // edge opposite each corner; w is the inverse mass of that corner
    float4 normal;      // unit, or zero where the triangle has no area
    float area;         // m²
} apsl_triangle_geometry;

static inline __attribute__((always_inline)) apsl_triangle_geometry triangle_geometry(float4 x0, float4 x1, float4 x2) {
    apsl_triangle_geometry t;
    t.e0 = x2 - x1;
    t.e1 = x0 - x2;
    t.e2 = x1 - x0;
    const float4 doubled = cross((float4)(t.e2.xyz, 0.0f), (float4)(-t.e1.xyz, 0.0f));
    const float length_of_doubled = sqrt(dot3(doubled, doubled));
    t.normal = length_of_doubled > 0.0f ? doubled / length_of_doubled : (float4)(0.0f);
    t.area = 0.5f * length_of_doubled;
    t.e0.w = x0.w;
    t.e1.w = x1.w;
    t.e2.w = x2.w;
    return t;
}

// Eq. (3): D = ½ Σ w |e|², kg⁻¹ m².
static inline __attribute__((always_inline)) float diagonal(apsl_triangle_geometry t) {
    return 0.5f * (t.e0.w * dot3(t.e0, t.e0) + t.e1.w * dot3(t.e1, t.e1) + t.e2.w * dot3(t.e2, t.e2));
}

// s = 1/√(α D); 0 where nothing can move the triangle, which makes its pressure 0 by definition.
static inline __attribute__((always_inline)) float jacobi_scale(float alpha, float d) {
    return d == 0.0f ? 0.0f : 1.0f / sqrt(alpha * d);
}

static inline __attribute__((always_inline)) apsl_gradients scaled_gradients(apsl_triangle_geometry t, float alpha,
                                                                             float scale) {
    apsl_gradients g;
    g.g0_shift = scale * cross(t.normal, (float4)(t.e0.xyz, 0.0f));
    g.g1_scale = scale * cross(t.normal, (float4)(t.e1.xyz, 0.0f));
    g.g0_shift.w = (alpha - 1.0f) / alpha;
    g.g1_scale.w = scale;
    return g;
}

// What is known of the areas of some triangles.
typedef struct {
    float max_change, squared_change, measured, not_finite;
} apsl_area_sums;

static inline __attribute__((always_inline)) void add_area(apsl_area_sums* sums, float area, float rest_area,
                                                           bool finite) {
    const bool has_rest_area = rest_area > 0.0f;
    const float change = has_rest_area ? fabs(area - rest_area) / rest_area : 0.0f;
    sums->max_change = fmax(sums->max_change, change);
    sums->squared_change += change * change;
    sums->measured += has_rest_area ? 1.0f : 0.0f;
    sums->not_finite += finite && isfinite(rest_area) ? 0.0f : 1.0f;
}

static inline __attribute__((always_inline)) void store_area_partials(apsl_area_sums sums, __global float* partials,
                                                                      __local float* scratch) {
    store_partial(partials, APSL_PARTIAL_MAX_CHANGE, group_max(sums.max_change, scratch));
    store_partial(partials, APSL_PARTIAL_SQUARED_CHANGE, group_sum(sums.squared_change, scratch));
    store_partial(partials, APSL_PARTIAL_MEASURED, group_sum(sums.measured, scratch));
    store_partial(partials, APSL_PARTIAL_NOT_FINITE, group_sum(sums.not_finite, scratch));
}

static inline __attribute__((always_inline)) apsl_triangle_geometry load_triangle(__global const uint* triangles,
                                                                                  __global const float4* predicted,
                                                                                  uint a) {
    const uint3 v = vload3(a, triangles);
    return triangle_geometry(predicted[v.x], predicted[v.y], predicted[v.z]);
}

// gradients[a], residual[a] = s (A − A⁰), and the sums that decide whether there is a solve at all.
APSL_KERNEL void assemble_gradients(__global const apsl_cloth* cloths, __global const apsl_parameters* parameters,
                                    __global const apsl_solve_state* states, __global float* partials,
                                    __global const uint* triangles, __global const float4* predicted,
                                    __global apsl_gradients* gradients, __global float* residual,
                                    __global float* damped_diagonal, __global const float* rest_areas,
                                    ulong rest_area_offset, __global const float* regularization,
                                    ulong regularization_offset) {
    APSL_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const apsl_cloth cloth = cloths[c];
    const apsl_range range = share_of(cloth.triangle_count, !states[c].stopped);
    apsl_area_sums sums = {0.0f, 0.0f, 0.0f, 0.0f};
    float residual_squared = 0.0f, scaled_squared = 0.0f;
#if APSL_REGULARIZATION_PER_TRIANGLE
    (void)parameters;
#else
    (void)regularization;
    (void)regularization_offset;
#endif
    for (uint t = range.first; t < range.end; t += APSL_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + t;
        const apsl_triangle_geometry triangle = load_triangle(triangles, predicted, a);
        const float rest_area = rest_areas[rest_area_offset + cloth.rest_area_begin + t];
#if APSL_REGULARIZATION_PER_TRIANGLE
        const float alpha = fmax(regularization[regularization_offset + cloth.rest_area_begin + t], 1.0f);
#else
        const float alpha = parameters[c].regularization;
#endif
        const float d = diagonal(triangle);
        const float scale = rest_area > 0.0f ? jacobi_scale(alpha, d) : 0.0f;
        const float stretch = scale > 0.0f ? triangle.area - rest_area : 0.0f;
        const float r = scale * stretch;
        gradients[a] = scaled_gradients(triangle, alpha, scale);
        residual[a] = r;
        damped_diagonal[a] = alpha * d;
        residual_squared += stretch * stretch;
        scaled_squared += r * r;
        add_area(&sums, triangle.area, rest_area, isfinite(triangle.area) && isfinite(d));
    }
    store_area_partials(sums, partials, scratch);
    store_partial(partials, APSL_PARTIAL_RESIDUAL_EVEN, group_sum(residual_squared, scratch));
    store_partial(partials, APSL_PARTIAL_SCALED_RESIDUAL_EVEN, group_sum(scaled_squared, scratch));
}

// The same sums without the gradients: the areas a call leaves behind.
APSL_KERNEL void measure_area_change(__global const apsl_cloth* cloths, __global float* partials,
                                     __global const uint* triangles, __global const float4* predicted,
                                     __global const float* rest_areas, ulong rest_area_offset) {
    APSL_SCRATCH;
    const apsl_cloth cloth = cloths[get_group_id(1)];
    const apsl_range range = share_of(cloth.triangle_count, true);
    apsl_area_sums sums = {0.0f, 0.0f, 0.0f, 0.0f};
    for (uint t = range.first; t < range.end; t += APSL_WORK_GROUP_SIZE) {
        const apsl_triangle_geometry triangle = load_triangle(triangles, predicted, cloth.triangle_begin + t);
        add_area(&sums, triangle.area, rest_areas[rest_area_offset + cloth.rest_area_begin + t],
                 isfinite(triangle.area) && isfinite(diagonal(triangle)));
    }
    store_area_partials(sums, partials, scratch);
}
