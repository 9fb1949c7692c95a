// SPDX-License-Identifier: MIT
// q = A r for the consistent matrix, patch by patch, and partial sums of r·q.
// Reference: apsl::reference::consistent_matrix times a vector.
// Moves, a triangle and with 1.1 for the patches' rims: 1.1 × (12 B corners, 2 + 2 B vertices, 24 B gradients, 4 B r)
// and 6 B local indices, 8 B shift read, 4 B written.
#include "conjugate_gradient.h"
#include "layout.h"
#include "patch_product.h"
#include "work_group.h"

APSLK_KERNEL void matrix_free_apply_dot(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                                        __global apslk_solve_state* states, __global float* partials,
                                        __global const uint2* patches, __global const uint* patch_vertices,
                                        __global const ushort* local_triangles, __global const uint* corner_offsets,
                                        __global const uint* corners, __global const apslk_gradients* gradients,
                                        __global const float* residual, __global float* product, int iteration) {
    APSLK_SCRATCH;
    __local float4 forces[APSLK_PATCH_VERTICES];
    const bool iterating = begin_iteration(parameters, states, partials, iteration, scratch);
    const float curvature =
        multiply_patches(cloths[get_group_id(1)], iterating, patches, patch_vertices, local_triangles, corner_offsets,
                         corners, gradients, residual, product, forces);
    store_partial(partials, APSLK_PARTIAL_CURVATURE, group_sum(curvature, scratch));
}
