// SPDX-License-Identifier: MIT
// The scaled matrix S (G + (α − 1) D) S in CSR form, one row a triangle.
// Reference: apsl::reference::consistent_matrix, printed_matrix, regularize.
// Moves about 13 × (4 + 1) B pattern and 13 gathered gradients (32 B, mostly from cache) read, 13 × 4 B written a row.
#include "gradients.h"
#include "layout.h"
#include "matrix_entries.h"
#include "work_group.h"

APSLK_KERNEL void assemble_pressure_csr(__global const apslk_cloth* cloths, __global const apslk_solve_state* states,
                                        __global const uint* triangles, __global const float4* moved,
                                        __global const apslk_gradients* gradients, __global const uint* row_offsets,
                                        __global const uint* columns, __global const uchar* shared,
                                        __global float* values) {
    const uint c = (uint)get_group_id(1);
    const apslk_cloth cloth = cloths[c];
    const apslk_range range = share_of(cloth.triangle_count, !states[c].stopped);
    for (uint t = range.first; t < range.end; t += APSLK_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + t;
        const uint end = row_offsets[a + 1];
        for (uint e = row_offsets[a]; e < end; ++e)
            values[e] = matrix_entry(triangles, moved, gradients, a, columns[e], shared[e]);
    }
}
