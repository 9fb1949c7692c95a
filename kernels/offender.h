// SPDX-License-Identifier: MIT
// Names what broke a call, or the triangle that it left worse: the first of the cloth, in the caller's order. Read only
// when there is one. Reference: apsl::reference, strain_limiter.
#ifndef APSLK_OFFENDER_H
#define APSLK_OFFENDER_H

#include "area_sums.h"
#include "layout.h"
#include "limits_stretch.h"
#include "triangle_geometry.h"
#include "vertex_motion.h"
#include "work_group.h"

#define APSLK_NOBODY 0xffffffffu

// Least over the work-group. Two halves, since scratch holds floats and those are exact below 2²⁴.
APSLK_INLINE uint group_min(uint value, __local float* scratch) {
    const float high = -group_max(-(float)(value >> 16), scratch);
    const float low = (value >> 16) == (uint)high ? (float)(value & 0xffffu) : 65535.0f;
    return ((uint)high << 16) | (uint)-group_max(-low, scratch);
}

// What to look for; the same in all of a work-group.
typedef struct {
    bool bad_vertices, bad_triangles;
    bool worst_triangle;    // the one whose area change is the greatest
    float greatest_change;  // which is this
} apslk_offender_search;

APSLK_INLINE apslk_offender_search search_for(bool broken, bool bad_vertices, apslk_verdict verdict,
                                              float greatest_change) {
    apslk_offender_search search;
    search.bad_vertices = broken && bad_vertices;
    search.bad_triangles = broken && !bad_vertices;
    search.worst_triangle = !broken && verdict.names;
    search.greatest_change = greatest_change;
    return search;
}

// The first vertex or triangle found in this work-item's share. `rest`: the limiter's rest values.
APSLK_INLINE uint first_offender(apslk_offender_search search, apslk_cloth cloth, __global const uint* vertex_order,
                                 __global const uint* triangle_order, __global const uint* triangles,
                                 __global const float4* moved, __global const float* rest) {
    uint first = APSLK_NOBODY;
    const uint vertices = search.bad_vertices ? cloth.vertex_count : 0u;
    for (uint v = (uint)get_local_id(0); v < vertices; v += APSLK_WORK_GROUP_SIZE) {
        const uint place = cloth.vertex_begin + v;
        if (is_bad_vertex(moved[place])) first = min(first, vertex_order[place] - cloth.vertex_begin);
    }
    // Another kernel found the greatest change, and may have rounded it otherwise.
    const float least_change = search.worst_triangle ? search.greatest_change * (1.0f - 1e-5f) : INFINITY;
    const uint blocks = search.bad_triangles || search.worst_triangle ? blocks_of(cloth) : 0u;
    for (uint block = (uint)get_local_id(0); block < blocks; block += APSLK_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + block * APSLK_LANES;
        const apslk_triangle_geometry triangle = load_triangles(triangles, moved, a);
        const lanes rest_area = load_lanes(rest, a);
        lanes witness = area_witness(triangle, rest_area), change = relative_change(triangle, rest_area);
#if APSLK_LIMITS_STRETCH
        const apslk_rest_shape shape = load_rest_shape(cloth, rest, a);
        const lanes excess = stretch_excess(principal_stretch(triangle, shape).value, shape.ceiling);
        witness += excess * excess;
        change = fmax(change, excess);
#endif
        const uint count = min((uint)APSLK_LANES, cloth.triangle_count - block * APSLK_LANES);
        for (uint n = 0; n < count; ++n) {
            const bool bad = search.bad_triangles && !(fabs(((const float*)&witness)[n]) < INFINITY);
            if (bad || ((const float*)&change)[n] >= least_change)
                first = min(first, triangle_order[a + n] - cloth.rest_area_begin);
        }
    }
    return first;
}

// By all of a work-group, whatever is looked for: there are barriers inside.
APSLK_INLINE void name_offender(__global apslk_stats* stats, apslk_offender_search search, apslk_cloth cloth,
                                __global const uint* vertex_order, __global const uint* triangle_order,
                                __global const uint* triangles, __global const float4* moved,
                                __global const float* rest, __local float* scratch) {
    const uint first =
        group_min(first_offender(search, cloth, vertex_order, triangle_order, triangles, moved, rest), scratch);
    if (get_local_id(0) == 0) {
        const bool named = first != APSLK_NOBODY;
        stats->offender = !named                ? APSLK_OFFENDER_NONE
                          : search.bad_vertices ? APSLK_OFFENDER_VERTEX
                                                : APSLK_OFFENDER_TRIANGLE;
        stats->offender_index = named ? first : 0u;
    }
}

#endif
