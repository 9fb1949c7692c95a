// SPDX-License-Identifier: MIT
// q = A r for the printed matrix, its entries made on the way: a gather over the triangles across each edge.
// Reference: apsl::reference::printed_matrix times a vector.
// Moves 4 × (4 + 1) B pattern, 4 B row offset, 12 B indices, about 5 × 32 B gradients (mostly from cache) a row.
#define APSLK_MATRIX 1
#include "conjugate_gradient.h"
#include "gradients.h"
#include "layout.h"
#include "matrix_entries.h"
#include "work_group.h"

APSLK_KERNEL void matrix_free_apply_dot(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                                        __global apslk_solve_state* states, __global float* partials,
                                        __global const uint* triangles, __global const float4* moved,
                                        __global const apslk_gradients* gradients, __global const uint* row_offsets,
                                        __global const uint* columns, __global const uchar* shared,
                                        __global const float* residual, __global float* product, int iteration) {
    APSLK_SCRATCH;
    const apslk_cloth cloth = cloths[get_group_id(1)];
    const bool iterating = begin_iteration(parameters, states, partials, iteration, scratch);
    const apslk_range range = share_of(cloth.triangle_count, iterating);
    float curvature = 0.0f;
    for (uint t = range.first; t < range.end; t += APSLK_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + t;
        const uint end = row_offsets[a + 1];
        float q = 0.0f;
        for (uint e = row_offsets[a]; e < end; ++e)
            q += matrix_entry(triangles, moved, gradients, a, columns[e], shared[e]) * residual[columns[e]];
        product[a] = q;
        curvature += residual[a] * q;
    }
    store_partial(partials, APSLK_PARTIAL_CURVATURE, group_sum(curvature, scratch));
}
