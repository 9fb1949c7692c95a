// SPDX-License-Identifier: MIT
// Area change at the moved positions. Reference: apsl::reference, area change.
#include "effective_mass.h"
#include "layout.h"
#include "limits_stretch.h"
#include "triangle_assembly.h"
#include "work_group.h"

#if APSLK_LIMITS_STRETCH
// Triangles of this work-item whose stretch row has a multiplier above zero.
APSLK_INLINE float stretch_rows_at_work(apslk_cloth cloth, bool active, __global const float* pressure) {
    const apslk_range range = share_of(cloth.triangle_count, active);
    float count = 0.0f;
    for (uint t = range.first; t < range.end; t += APSLK_WORK_GROUP_SIZE)
        count += pressure[cloth.run + cloth.triangle_begin + t] > 0.0f ? 1.0f : 0.0f;
    return count;
}
#endif

#if APSLK_INTEGRATES
// By how much a triangle of this work-item misses its limits at most: its area change, or stretch over the ceiling, as
// a whole step leaves it or began with it. `errors`: of the start of the step, as find_start_errors leaves them.
// Reference: apsl::reference, worst_miss.
APSLK_INLINE float worst_miss(apslk_cloth cloth, bool active, __global const uint* triangles,
                              __global const float4* moved, __global const float* rest, __global const float* errors) {
    const apslk_range range = share_of(blocks_of(cloth), active);
    lanes worst = 0.0f;
    for (uint block = range.first; block < range.end; block += APSLK_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + block * APSLK_LANES;
        const apslk_triangle_geometry triangle = load_triangles(triangles, moved, a);
        const lanes rest_area = load_lanes(rest, a);
        const lanes at_start = select((lanes)(0.0f), fabs(load_lanes(errors, a)) / rest_area, rest_area > 0.0f);
        worst = fmax(worst, fmax(at_start, relative_change(triangle, rest_area)));
#if APSLK_LIMITS_STRETCH
        const apslk_rest_shape shape = load_rest_shape(cloth, rest, a);
        worst = fmax(worst, stretch_excess(principal_stretch(triangle, shape).value, shape.ceiling));
        worst = fmax(worst, load_lanes(errors + APSLK_START_EXCESS * cloth.run, a));
#endif
    }
    return max_of_lanes(worst);
}
#endif

// What a call leaves behind, and the vertices that weighed more than given; of a whole step by how much it misses its
// limits, too.
// Moves 12 B indices, about 8 B positions, 4 B rest area read a triangle; with raised masses 32 B a vertex. A whole
// step moves as much again, 4 B start error and, with a ceiling, 20 B rest shape and 4 B excess read.
APSLK_KERNEL void measure_area_change(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                                      __global float* partials, __global const uint* triangles,
                                      __global const float4* moved, __global const float4* motion,
                                      __global const float* rest, __global const float* pressure,
                                      __global const float* start_errors) {
    APSLK_SCRATCH;
    const uint c = (uint)get_group_id(1);
    store_area_partials(measure_triangles(cloths[c], parameters[c].enabled, triangles, moved, rest), partials, scratch);
#if APSLK_LIMITS_STRETCH
    store_partial(partials, APSLK_PARTIAL_STRETCH_ROWS,
                  group_sum(stretch_rows_at_work(cloths[c], parameters[c].enabled, pressure), scratch));
#else
    (void)pressure;
#endif
#if APSLK_INTEGRATES
    store_partial(
        partials, APSLK_PARTIAL_WORST_MISS,
        group_max(worst_miss(cloths[c], parameters[c].enabled, triangles, moved, rest, start_errors), scratch));
#else
    (void)start_errors;
#endif
    const apslk_raised_masses raised = raised_masses(cloths[c], parameters[c].raises_masses, moved, motion);
    store_partial(partials, APSLK_PARTIAL_RAISED, group_sum(raised.count, scratch));
    store_partial(partials, APSLK_PARTIAL_MASS_RATIO, group_max(raised.greatest_ratio, scratch));
}

// Before small steps: what the whole step comes to, and what the areas are off by at its start, whose vertices are in
// `motion`. Moves 12 B indices, about 16 B positions, 4 B rest area read, 4 B written a triangle.
APSLK_KERNEL void measure_step(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                               __global float* partials, __global const uint* triangles, __global const float4* moved,
                               __global const float4* motion, __global const float* rest,
                               __global float* start_errors) {
    APSLK_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const bool in_small_steps = small_step_count(parameters[c]) > 0;
    apslk_area_sums sums = measure_triangles(cloths[c], parameters[c].enabled, triangles, moved, rest);
    sums.not_finite += find_start_errors(cloths[c], in_small_steps, triangles, motion, rest, start_errors);
    store_area_partials(sums, partials, scratch);
}
