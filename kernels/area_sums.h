// SPDX-License-Identifier: MIT
// What a launch finds out about the areas of its triangles. Reference: apsl::reference, area change.
#ifndef APSL_AREA_SUMS_H
#define APSL_AREA_SUMS_H

#include "layout.h"
#include "triangle_geometry.h"
#include "work_group.h"

typedef struct {
    lanes max_change, squared_change, measured, not_finite;
} apsl_area_sums;

APSL_INLINE apsl_area_sums no_areas(void) {
    apsl_area_sums sums;
    sums.max_change = 0.0f;
    sums.squared_change = 0.0f;
    sums.measured = 0.0f;
    sums.not_finite = 0.0f;
    return sums;
}

// A cloth's triangles are taken in blocks of APSL_LANES; the last one may reach into the padding,
// where there are no rest areas.
APSL_INLINE uint blocks_of(apsl_cloth cloth) {
    return (cloth.triangle_count + APSL_LANES - 1u) / APSL_LANES;
}

APSL_INLINE void add_areas(apsl_area_sums* sums, apsl_triangle_geometry triangle, lanes rest_area) {
    const lanes change = select((lanes)(0.0f), fabs(triangle.area - rest_area) / rest_area, rest_area > 0.0f);
    sums->max_change = select(sums->max_change, change, change > sums->max_change);
    sums->squared_change += change * change;
    sums->measured += select((lanes)(0.0f), (lanes)(1.0f), rest_area > 0.0f);
    // A NaN or an infinity in any of the three survives their sum.
    const lanes witness = triangle.area + triangle.diagonal + rest_area;
    sums->not_finite += select((lanes)(1.0f), (lanes)(0.0f), fabs(witness) < INFINITY);
}

APSL_INLINE void store_area_partials(apsl_area_sums sums, __global float* partials, __local float* scratch) {
    store_partial(partials, APSL_PARTIAL_MAX_CHANGE, group_max(max_of_lanes(sums.max_change), scratch));
    store_partial(partials, APSL_PARTIAL_SQUARED_CHANGE, group_sum(sum_of_lanes(sums.squared_change), scratch));
    store_partial(partials, APSL_PARTIAL_MEASURED, group_sum(sum_of_lanes(sums.measured), scratch));
    store_partial(partials, APSL_PARTIAL_NOT_FINITE, group_sum(sum_of_lanes(sums.not_finite), scratch));
}

#endif
