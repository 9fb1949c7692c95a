// SPDX-License-Identifier: MIT
// What a launch finds out about the areas of its triangles. Reference: apsl::reference, area change.
#ifndef APSLK_AREA_SUMS_H
#define APSLK_AREA_SUMS_H

#include "accept_or_reject.h"
#include "layout.h"
#include "limits_stretch.h"
#include "principal_stretch.h"
#include "triangle_geometry.h"
#include "work_group.h"

typedef struct {
    lanes max_change, squared_change, capped_change, measured, not_finite;
#if APSLK_LIMITS_STRETCH
    lanes max_stretch, max_excess, squared_excess;
#endif
} apslk_area_sums;

APSLK_INLINE apslk_area_sums no_areas(void) {
    apslk_area_sums sums;
    sums.max_change = 0.0f;
    sums.squared_change = 0.0f;
    sums.capped_change = 0.0f;
    sums.measured = 0.0f;
    sums.not_finite = 0.0f;
#if APSLK_LIMITS_STRETCH
    sums.max_stretch = 0.0f;
    sums.max_excess = 0.0f;
    sums.squared_excess = 0.0f;
#endif
    return sums;
}

// A cloth's triangles are taken in blocks of APSLK_LANES; the last one may reach into the padding,
// where there are no rest areas.
APSLK_INLINE uint blocks_of(apslk_cloth cloth) {
    return (cloth.triangle_count + APSLK_LANES - 1u) / APSLK_LANES;
}

// |A − A⁰| / A⁰; 0 where there is no rest area.
APSLK_INLINE lanes relative_change(apslk_triangle_geometry triangle, lanes rest_area) {
    return select((lanes)(0.0f), fabs(triangle.area - rest_area) / rest_area, rest_area > 0.0f);
}

// Not finite where the diagonal, the rest area or the square of the area or of its change is not, or the rest area is
// negative: a NaN or an infinity in any of them survives their sum.
APSLK_INLINE lanes area_witness(apslk_triangle_geometry triangle, lanes rest_area) {
    const lanes change = relative_change(triangle, rest_area);
    return select((lanes)(INFINITY), triangle.area * triangle.area + change * change + triangle.diagonal + rest_area,
                  rest_area >= 0.0f);
}

APSLK_INLINE void add_areas(apslk_area_sums* sums, apslk_triangle_geometry triangle, lanes rest_area) {
    const lanes change = relative_change(triangle, rest_area);
    sums->max_change = select(sums->max_change, change, change > sums->max_change);
    const lanes weight = select((lanes)(0.0f), rest_area, rest_area > 0.0f);
    sums->squared_change += weight * change * change;
    const lanes capped = fmin(change, (lanes)(1.0f));
    sums->capped_change += weight * capped * capped;
    sums->measured += weight;
    sums->not_finite += select((lanes)(1.0f), (lanes)(0.0f), fabs(area_witness(triangle, rest_area)) < INFINITY);
}

#if APSLK_LIMITS_STRETCH
// `drawn`: principal stretches. Triangles without a ceiling have no say.
APSLK_INLINE void add_stretches(apslk_area_sums* sums, lanes rest_area, apslk_rest_shape shape, lanes drawn) {
    const lanes stretch = select((lanes)(0.0f), drawn, shape.ceiling > 0.0f);
    const lanes excess = stretch_excess(stretch, shape.ceiling);
    const lanes weight = select((lanes)(0.0f), rest_area, rest_area > 0.0f);
    sums->max_stretch = fmax(sums->max_stretch, stretch);
    sums->max_excess = fmax(sums->max_excess, excess);
    sums->squared_excess += weight * excess * excess;
    const lanes capped = fmin(excess, (lanes)(1.0f));
    sums->capped_change += weight * capped * capped;
    sums->not_finite += select((lanes)(1.0f), (lanes)(0.0f), stretch * stretch < INFINITY);
}
#endif

// From the sums over a cloth.
APSLK_INLINE apslk_area_change area_change_of(float max, float squared, float capped, float measured) {
    apslk_area_change change;
    change.max = max;
#if APSLK_LIMITS_STRETCH
    change.max_stretch = 0.0f;
    change.max_excess = 0.0f;
    change.rms_excess = 0.0f;
#endif
    change.measured = measured;
    change.rms = measured > 0.0f ? sqrt(squared / measured) : 0.0f;
    change.capped_rms = measured > 0.0f ? sqrt(capped / measured) : 0.0f;
    return change;
}

// By a work-group that has all triangles of a cloth; there are barriers inside.
APSLK_INLINE apslk_area_change area_change_in_group(apslk_area_sums sums, __local float* scratch) {
    const float squared = group_sum(sum_of_lanes(sums.squared_change), scratch);
    const float capped = group_sum(sum_of_lanes(sums.capped_change), scratch);
    const float measured = group_sum(sum_of_lanes(sums.measured), scratch);
    return area_change_of(group_max(max_of_lanes(sums.max_change), scratch), squared, capped, measured);
}

APSLK_INLINE void store_area_partials(apslk_area_sums sums, __global float* partials, __local float* scratch) {
    store_partial(partials, APSLK_PARTIAL_MAX_CHANGE, group_max(max_of_lanes(sums.max_change), scratch));
    store_partial(partials, APSLK_PARTIAL_SQUARED_CHANGE, group_sum(sum_of_lanes(sums.squared_change), scratch));
    store_partial(partials, APSLK_PARTIAL_CAPPED_CHANGE, group_sum(sum_of_lanes(sums.capped_change), scratch));
    store_partial(partials, APSLK_PARTIAL_MEASURED, group_sum(sum_of_lanes(sums.measured), scratch));
    store_partial(partials, APSLK_PARTIAL_NOT_FINITE, group_sum(sum_of_lanes(sums.not_finite), scratch));
#if APSLK_LIMITS_STRETCH
    store_partial(partials, APSLK_PARTIAL_MAX_STRETCH, group_max(max_of_lanes(sums.max_stretch), scratch));
    store_partial(partials, APSLK_PARTIAL_MAX_EXCESS, group_max(max_of_lanes(sums.max_excess), scratch));
    store_partial(partials, APSLK_PARTIAL_SQUARED_EXCESS, group_sum(sum_of_lanes(sums.squared_excess), scratch));
#endif
}

#endif
