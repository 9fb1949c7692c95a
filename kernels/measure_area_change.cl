// SPDX-License-Identifier: MIT
// Area change at the predicted positions: what a call leaves behind. Reference: apsl::reference, area change.
// Moves 12 B indices, about 8 B positions, 4 B rest area read a triangle.
#include "layout.h"
#include "triangle_assembly.h"
#include "work_group.h"

APSL_KERNEL void measure_area_change(__global const apsl_cloth* cloths, __global const apsl_parameters* parameters,
                                     __global float* partials, __global const uint* triangles,
                                     __global const float4* predicted, __global const float* rest_areas) {
    APSL_SCRATCH;
    const uint c = (uint)get_group_id(1);
    store_area_partials(measure_triangles(cloths[c], parameters[c].enabled, triangles, predicted, rest_areas), partials,
                        scratch);
}
