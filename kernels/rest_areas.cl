// SPDX-License-Identifier: MIT
// A⁰ of the caller's triangles from rest positions, once for a cloth. Reference: apsl::reference::areas.
// Moves 12 B indices, 4 B order, 3 × (4 B order, 12 B positions, mostly from cache) read, 4 B written a triangle.
#include "layout.h"
#include "limits_stretch.h"
#include "vertex_motion.h"
#include "work_group.h"

APSLK_INLINE float3 rest_position(__global const uint* vertex_order, __global const float* rest_positions, uint place) {
    return load_position(rest_positions, vertex_order[place]);
}

// x₁ − x₀ and x₂ − x₀ of a triangle at its place.
typedef struct {
    float3 first, second;
} apslk_rest_edges;

APSLK_INLINE apslk_rest_edges rest_edges(__global const uint* vertex_order, __global const uint* triangles,
                                         __global const float* rest_positions, uint a) {
    const float3 x0 = rest_position(vertex_order, rest_positions, triangles[3 * a]);
    apslk_rest_edges edges;
    edges.first = rest_position(vertex_order, rest_positions, triangles[3 * a + 1]) - x0;
    edges.second = rest_position(vertex_order, rest_positions, triangles[3 * a + 2]) - x0;
    return edges;
}

// Zero where two corners coincide: a compiler that fuses a product with a difference leaves a rounding error there,
// which would count as a rest area.
APSLK_INLINE float doubled_area(apslk_rest_edges e) {
    const float3 third = e.second - e.first;
    const bool coincide = all(e.first == 0.0f) || all(e.second == 0.0f) || all(third == 0.0f);
    return coincide ? 0.0f : length(cross(e.first, e.second));
}

APSLK_KERNEL void rest_areas(__global const apslk_cloth* cloths, __global const uint* vertex_order,
                             __global const uint* triangle_order, __global const uint* triangles,
                             __global const float* rest_positions, ulong rest_position_offset, __global float* areas,
                             ulong area_offset) {
    const apslk_cloth cloth = cloths[get_group_id(1)];
    const apslk_range range = share_of(cloth.triangle_count, true);
    for (uint t = range.first; t < range.end; t += APSLK_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + t;
        const apslk_rest_edges e = rest_edges(vertex_order, triangles, rest_positions + rest_position_offset, a);
        areas[area_offset + triangle_order[a]] = 0.5f * doubled_area(e);
    }
}

#if APSLK_LIMITS_STRETCH
// M of the caller's triangles, row by row: the inverse of their rest edges in their plane, the first along x. Zeros
// where a triangle has no area. Reference: apsl::reference::rest_shapes. Moves what rest_areas does, and 16 B written.
APSLK_KERNEL void rest_shapes(__global const apslk_cloth* cloths, __global const uint* vertex_order,
                              __global const uint* triangle_order, __global const uint* triangles,
                              __global const float* rest_positions, ulong rest_position_offset, __global float* shapes,
                              ulong shape_offset) {
    const apslk_cloth cloth = cloths[get_group_id(1)];
    const apslk_range range = share_of(cloth.triangle_count, true);
    for (uint t = range.first; t < range.end; t += APSLK_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + t;
        const apslk_rest_edges e = rest_edges(vertex_order, triangles, rest_positions + rest_position_offset, a);
        const float base = length(e.first), doubled = doubled_area(e);
        const float height = doubled / base, along = dot(e.first, e.second) / base;
        const float4 shape =
            doubled > 0.0f ? (float4)(1.0f / base, -along / doubled, 0.0f, 1.0f / height) : (float4)(0.0f);
        vstore4(shape, triangle_order[a], shapes + shape_offset);
    }
}
#endif
