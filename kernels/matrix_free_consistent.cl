// SPDX-License-Identifier: MIT
// q = A r for the consistent matrix without assembling it: A = J̃ ½W J̃ᵀ + diag((α − 1)/α), one pass over the vertices
// and one over the triangles. Reference: apsl::reference::consistent_matrix times a vector.
#include "conjugate_gradient.h"
#include "gradients.h"
#include "layout.h"
#include "vertex_gather.h"
#include "work_group.h"

// u_i = ½ w_i Σ_{a∋i} r_a ĝ_{a,i}. Moves 12 B corners, 2 B offsets, 32 B gradients, 4 B r read, 8 B written a triangle.
APSL_KERNEL void gather_vertex_forces(__global const apsl_cloth* cloths, __global const apsl_parameters* parameters,
                                      __global apsl_solve_state* states, __global float* partials,
                                      __global const uint* corner_offsets, __global const uint* corners,
                                      __global const float4* predicted, __global const apsl_gradients* gradients,
                                      __global const float* residual, __global float4* vertex_forces, int iteration) {
    APSL_SCRATCH;
    const apsl_cloth cloth = cloths[get_group_id(1)];
    const bool iterating = begin_iteration(parameters, states, partials, iteration, scratch);
    const apsl_range range = share_of(cloth.vertex_count, iterating);
    for (uint v = range.first; v < range.end; v += APSL_WORK_GROUP_SIZE) {
        const uint i = cloth.vertex_begin + v;
        vertex_forces[i] = 0.5f * predicted[i].w * sum_over_corners(corner_offsets, corners, gradients, residual, i);
    }
}

// q_a = Σ_k ĝ_{a,k} · u_k + (α − 1)/α r_a, partial sums of r·q.
// Moves 12 B indices, 8 B forces, 32 B gradients, 4 B r read, 4 B written a triangle.
APSL_KERNEL void matrix_free_apply_dot(__global const apsl_cloth* cloths, __global const apsl_solve_state* states,
                                       __global float* partials, __global const uint* triangles,
                                       __global const apsl_gradients* gradients, __global const float4* vertex_forces,
                                       __global const float* residual, __global float* product) {
    APSL_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const apsl_cloth cloth = cloths[c];
    const apsl_range range = share_of(cloth.triangle_count, states[c].iterating != 0);
    float curvature = 0.0f;
    for (uint t = range.first; t < range.end; t += APSL_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + t;
        const uint3 v = vload3(a, triangles);
        const apsl_gradients g = gradients[a];
        // The third gradient is minus the sum of the first two.
        const float4 u2 = vertex_forces[v.z];
        const float r = residual[a];
        const float q =
            dot3(g.g0_shift, vertex_forces[v.x] - u2) + dot3(g.g1_scale, vertex_forces[v.y] - u2) + g.g0_shift.w * r;
        product[a] = q;
        curvature += r * q;
    }
    store_partial(partials, APSL_PARTIAL_CURVATURE, group_sum(curvature, scratch));
}
