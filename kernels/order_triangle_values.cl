// SPDX-License-Identifier: MIT
// Rest areas, and α where each triangle has its own, in the limiter's order of triangles: gathered once a call, read in
// every sub-step. Moves 4 B order, 4 B rest area read, 4 B written a triangle; α likewise.
#include "layout.h"
#include "triangle_assembly.h"
#include "work_group.h"

APSLK_KERNEL void order_triangle_values(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                                        __global const uint* triangle_order, __global float* ordered_rest_areas,
                                        __global float* ordered_scaling, __global const float* rest_areas,
                                        ulong rest_area_offset, __global const float* regularization,
                                        ulong regularization_offset) {
    const uint c = (uint)get_group_id(1);
    order_values(cloths[c], parameters[c].enabled, triangle_order, ordered_rest_areas, ordered_scaling,
                 rest_areas + rest_area_offset, regularization + regularization_offset);
}
