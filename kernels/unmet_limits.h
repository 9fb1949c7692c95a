// SPDX-License-Identifier: MIT
// Triangles outside their limits: those that a whole step leaves, or began with, whose area change or stretch over the
// ceiling is above APSLK_UNMET. Reference: apsl::reference, unmet_vertices.
#ifndef APSLK_UNMET_LIMITS_H
#define APSLK_UNMET_LIMITS_H

#include "layout.h"
#include "limits_stretch.h"
#include "triangle_assembly.h"
#include "work_group.h"

// `errors`: of the start of the step, as find_start_errors leaves them; the first run becomes 1 for a triangle outside
// its limits and 0 otherwise.
APSLK_INLINE void mark_unmet(apslk_cloth cloth, bool active, __global const uint* triangles,
                             __global const float4* moved, __global const float* rest, __global float* errors) {
    const apslk_range range = share_of(blocks_of(cloth), active);
    for (uint block = range.first; block < range.end; block += APSLK_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + block * APSLK_LANES;
        const apslk_triangle_geometry triangle = load_triangles(triangles, moved, a);
        const lanes rest_area = load_lanes(rest, a);
        const lanes at_start = select((lanes)(0.0f), fabs(load_lanes(errors, a)) / rest_area, rest_area > 0.0f);
        lanes worst = fmax(at_start, relative_change(triangle, rest_area));
#if APSLK_LIMITS_STRETCH
        const apslk_rest_shape shape = load_rest_shape(cloth, rest, a);
        worst = fmax(worst, stretch_excess(principal_stretch(triangle, shape).value, shape.ceiling));
        worst = fmax(worst, load_lanes(errors + APSLK_START_EXCESS * cloth.run, a));
#endif
        store_lanes(select((lanes)(0.0f), (lanes)(1.0f), worst > APSLK_UNMET), errors, a);
    }
}

// Whether a triangle at vertex i of the limiter's order is outside its limits.
APSLK_INLINE bool is_unmet(__global const uint* corner_offsets, __global const uint* corners,
                           __global const float* unmet, uint i) {
    bool found = false;
    const uint end = corner_offsets[i + 1];
    for (uint n = corner_offsets[i]; n < end; ++n) found = found || unmet[APSLK_CORNER_TRIANGLE(corners[n])] > 0.0f;
    return found;
}

#endif
