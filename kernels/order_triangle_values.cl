// SPDX-License-Identifier: MIT
// Rest areas, and α where each triangle has its own, in the limiter's order of triangles: gathered once a call, read in
// every sub-step. Moves 4 B order, 4 B rest area read, 4 B written a triangle; α likewise.
#include "layout.h"
#include "limits_stretch.h"
#include "triangle_assembly.h"
#include "work_group.h"

APSLK_KERNEL void order_triangle_values(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                                        __global const uint* triangle_order, __global float* ordered_rest,
                                        __global float* ordered_scaling, __global const float* rest_areas,
                                        ulong rest_area_offset, __global const float* regularization,
                                        ulong regularization_offset) {
    const uint c = (uint)get_group_id(1);
    order_values(cloths[c], parameters[c].enabled, triangle_order, ordered_rest, ordered_scaling,
                 rest_areas + rest_area_offset, regularization + regularization_offset);
}

#if APSLK_LIMITS_STRETCH
// Rest shapes and ceilings likewise, after the rest areas. Moves 4 B order, 16 B shape, 4 B rest area read, 16 B
// written a triangle; ceilings 4 B more.
APSLK_KERNEL void order_stretch_limits(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                                       __global const uint* triangle_order, __global float* ordered_rest,
                                       __global const float* rest_shapes, ulong rest_shape_offset,
                                       __global const float* stretch_ceilings, ulong stretch_ceiling_offset) {
    const uint c = (uint)get_group_id(1);
    order_rest_shapes(cloths[c], parameters[c].enabled, parameters[c].stretch_ceiling, triangle_order, ordered_rest,
                      rest_shapes + rest_shape_offset, stretch_ceilings + stretch_ceiling_offset);
}
#endif
