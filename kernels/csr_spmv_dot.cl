// SPDX-License-Identifier: MIT
// q = A r from the assembled rows, partial sums of r·q. Reference: Eigen's sparse product.
// Moves 13 × (4 + 4) B entries, 4 B row offset, 4 B r read, 4 B written a row of the consistent matrix.
#include "conjugate_gradient.h"
#include "layout.h"
#include "work_group.h"

APSLK_KERNEL void csr_spmv_dot(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                               __global apslk_solve_state* states, __global float* partials,
                               __global const uint* row_offsets, __global const uint* columns,
                               __global const float* values, __global const float* residual, __global float* product,
                               int iteration) {
    APSLK_SCRATCH;
    const apslk_cloth cloth = cloths[get_group_id(1)];
    const bool iterating = begin_iteration(parameters, states, partials, iteration, scratch);
    const apslk_range range = share_of(cloth.triangle_count, iterating);
    float curvature = 0.0f;
    for (uint t = range.first; t < range.end; t += APSLK_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + t;
        const uint end = row_offsets[a + 1];
        float q = 0.0f;
        for (uint e = row_offsets[a]; e < end; ++e) q += values[e] * residual[columns[e]];
        product[a] = q;
        curvature += residual[a] * q;
    }
    store_partial(partials, APSLK_PARTIAL_CURVATURE, group_sum(curvature, scratch));
}
