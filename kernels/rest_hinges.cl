// SPDX-License-Identifier: MIT
// Hinges at rest from rest positions, once for a cloth: the angle, rad, and l²/(A₀ + A₁) of edge and triangles; zeros
// where one of these has no area. Reference: apsl::reference::rest_hinges. Moves 16 B indices, 4 B order,
// 4 × (4 B order, 12 B positions, mostly from cache) read, 8 B written a hinge.
#include "hinges.h"
#include "layout.h"
#include "vertex_motion.h"
#include "work_group.h"

APSLK_KERNEL void rest_hinges(__global const uint* hinge_offsets, __global const uint* vertex_order,
                              __global const uint* hinge_order, __global const uint4* hinges,
                              __global const float* rest_positions, ulong rest_position_offset,
                              __global float* rest_hinges, ulong rest_hinge_offset) {
    const uint c = (uint)get_group_id(1), first_hinge = hinge_offsets[c];
    const apslk_range range = share_of(hinge_offsets[c + 1] - first_hinge, true);
    __global const float* positions = rest_positions + rest_position_offset;
    for (uint h = range.first; h < range.end; h += APSLK_WORK_GROUP_SIZE) {
        const uint r = first_hinge + h;
        const uint4 v = hinges[r];
        const float3 e0 = load_position(positions, vertex_order[v.x]), e1 = load_position(positions, vertex_order[v.y]),
                     o0 = load_position(positions, vertex_order[v.z]), o1 = load_position(positions, vertex_order[v.w]);
        const apslk_hinge_geometry hinge = hinge_geometry(e0, e1, o0, o1);
        const float3 edge = e1 - e0;
        const float doubled_areas = length(cross(edge, o0 - e0)) + length(cross(o1 - e0, edge));
        // A triangle without area has no gradient.
        const bool bends = any(hinge.gradients.at_first.xyz != 0.0f);
        const float2 rest =
            bends ? (float2)(hinge.angle, 2.0f * dot(edge, edge) / doubled_areas) : (float2)(0.0f, 0.0f);
        vstore2(rest, hinge_order[r], rest_hinges + rest_hinge_offset);
    }
}
