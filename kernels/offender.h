// SPDX-License-Identifier: MIT
// Names what broke a call: the first vertex or triangle of a cloth, in the caller's order. Read only when something
// did. Reference: apsl::reference, strain_limiter.
#ifndef APSL_OFFENDER_H
#define APSL_OFFENDER_H

#include "area_sums.h"
#include "layout.h"
#include "triangle_geometry.h"
#include "vertex_motion.h"
#include "work_group.h"

#define APSL_NOBODY 0xffffffffu

// Least over the work-group. Two halves, since scratch holds floats and those are exact below 2²⁴.
APSL_INLINE uint group_min(uint value, __local float* scratch) {
    const float high = -group_max(-(float)(value >> 16), scratch);
    const float low = (value >> 16) == (uint)high ? (float)(value & 0xffffu) : 65535.0f;
    return ((uint)high << 16) | (uint)-group_max(-low, scratch);
}

// The first of the cloth's bad vertices, or where there are none (`vertices_are_bad` is false) the first of its bad
// triangles, in this work-item's share; nobody where the call is not `broken`. `rest_areas` are in the limiter's order.
APSL_INLINE uint first_offender(bool broken, bool vertices_are_bad, apsl_cloth cloth, __global const uint* vertex_order,
                                __global const uint* triangle_order, __global const uint* triangles,
                                __global const float4* predicted, __global const float* rest_areas) {
    uint first = APSL_NOBODY;
    const uint vertices = broken && vertices_are_bad ? cloth.vertex_count : 0u;
    for (uint v = (uint)get_local_id(0); v < vertices; v += APSL_WORK_GROUP_SIZE) {
        const uint place = cloth.vertex_begin + v;
        if (is_bad_vertex(predicted[place])) first = min(first, vertex_order[place] - cloth.vertex_begin);
    }
    const uint blocks = broken && !vertices_are_bad ? blocks_of(cloth) : 0u;
    for (uint block = (uint)get_local_id(0); block < blocks; block += APSL_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + block * APSL_LANES;
        const lanes witness = area_witness(load_triangles(triangles, predicted, a), load_lanes(rest_areas, a));
        const uint count = min((uint)APSL_LANES, cloth.triangle_count - block * APSL_LANES);
        for (uint n = 0; n < count; ++n)
            if (!(fabs(((const float*)&witness)[n]) < INFINITY))
                first = min(first, triangle_order[a + n] - cloth.rest_area_begin);
    }
    return first;
}

// By all of a work-group, broken or not: there are barriers inside.
APSL_INLINE void name_offender(__global apsl_stats* stats, bool broken, bool vertices_are_bad, apsl_cloth cloth,
                               __global const uint* vertex_order, __global const uint* triangle_order,
                               __global const uint* triangles, __global const float4* predicted,
                               __global const float* rest_areas, __local float* scratch) {
    const uint first = group_min(
        first_offender(broken, vertices_are_bad, cloth, vertex_order, triangle_order, triangles, predicted, rest_areas),
        scratch);
    if (get_local_id(0) == 0) {
        const bool named = first != APSL_NOBODY;
        stats->offender = !named             ? APSL_OFFENDER_NONE
                          : vertices_are_bad ? APSL_OFFENDER_VERTEX
                                             : APSL_OFFENDER_TRIANGLE;
        stats->offender_index = named ? first : 0u;
    }
}

#endif
