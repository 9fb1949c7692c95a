// SPDX-License-Identifier: MIT
// What bounds the matrix, vertex by vertex: J_i J_iᵀ ≼ s_i diag(|g_{a,i}|²), J_i with the corner gradients around
// vertex i for rows, and s_i the greatest eigenvalue of Σ_{a∋i} ĝ ĝᵀ, ĝ = g/|g|, or a little more. assemble_triangles
// makes B_a = Σ_{i∈a} s_i ½ w_i |g_{a,i}|² of it. Reference: apsl::reference::vertex_bounds.
#include "gradients.h"
#include "lanes.h"
#include "layout.h"
#include "limits_stretch.h"
#include "work_group.h"

// Symmetric 3×3 matrices.
typedef struct {
    lanes xx, yy, zz, xy, xz, yz;
} apslk_symmetric;

APSLK_INLINE apslk_symmetric squared(apslk_symmetric m) {
    apslk_symmetric s;
    s.xx = m.xx * m.xx + m.xy * m.xy + m.xz * m.xz;
    s.yy = m.xy * m.xy + m.yy * m.yy + m.yz * m.yz;
    s.zz = m.xz * m.xz + m.yz * m.yz + m.zz * m.zz;
    s.xy = m.xy * (m.xx + m.yy) + m.xz * m.yz;
    s.xz = m.xz * (m.xx + m.zz) + m.xy * m.yz;
    s.yz = m.yz * (m.yy + m.zz) + m.xy * m.xz;
    return s;
}

// (Σ λ³²)^(1/32) over the eigenvalues, none below 0: the greatest, or up to 1.04 times that.
APSLK_INLINE lanes greatest_eigenvalue(apslk_symmetric m) {
    const lanes trace = m.xx + m.yy + m.zz;
    const lanes inverse = select((lanes)(0.0f), 1.0f / trace, trace > 0.0f);
    m.xx *= inverse;
    m.yy *= inverse;
    m.zz *= inverse;
    m.xy *= inverse;
    m.xz *= inverse;
    m.yz *= inverse;
    const apslk_symmetric p = squared(squared(squared(squared(m))));
    const lanes sum = p.xx * p.xx + p.yy * p.yy + p.zz * p.zz + 2.0f * (p.xy * p.xy + p.xz * p.xz + p.yz * p.yz);
    return trace * sqrt(sqrt(sqrt(sqrt(sqrt(sum)))));
}

// s_i, from gradients in any scale; a gradient of zero may get any direction. Moves 12 B corners, 2 B
// offsets, 24 B gradients read, 2 B written, a triangle; with raised masses 16 B more read.
APSLK_KERNEL void bound_vertices(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                                 __global const apslk_solve_state* states, __global const uint* corner_offsets,
                                 __global const uint* corners, __global const apslk_gradients* gradients,
                                 __global const float4* moved, __global const float4* motion,
                                 __global float* vertex_bounds) {
    const uint c = (uint)get_group_id(1);
    const apslk_cloth cloth = cloths[c];
    const apslk_range range = share_of((cloth.vertex_count + APSLK_LANES - 1u) / APSLK_LANES, !states[c].stopped);
    for (uint block = range.first; block < range.end; block += APSLK_WORK_GROUP_SIZE) {
        const uint first = block * APSLK_LANES;
        const uint count = min((uint)APSLK_LANES, cloth.vertex_count - first);
        float entries[6 * APSLK_LANES] = {0.0f}, gradients_around[APSLK_LANES] = {0.0f}, bounds[APSLK_LANES];
        for (uint v = 0; v < count; ++v) {
            const uint i = cloth.vertex_begin + first + v;
            float4 on_diagonal = (float4)(0.0f), beside = (float4)(0.0f);
            const uint begin = corner_offsets[i], end = corner_offsets[i + 1];
            for (uint n = begin; n < end; ++n) {
                const float4 g = corner_gradient(gradients, corners[n]), squares = g * g;
                // Of whole numbers: 0, or at least 1.
                const float inverse = 1.0f / fmax(squares.x + squares.y + squares.z, 1.0f);
                on_diagonal += inverse * squares;
                beside += inverse * (g.xxyw * g.yzzw);
#if APSLK_LIMITS_STRETCH
                if (has_stretch_row(gradients, APSLK_CORNER_TRIANGLE(corners[n]))) {
                    const float4 d = corner_gradient(gradients + cloth.run, corners[n]), d_squares = d * d;
                    const float d_inverse = 1.0f / fmax(d_squares.x + d_squares.y + d_squares.z, 1.0f);
                    on_diagonal += d_inverse * d_squares;
                    beside += d_inverse * (d.xxyw * d.yzzw);
                    gradients_around[v] += 1.0f;
                }
#endif
            }
            gradients_around[v] += (float)(end - begin);
            entries[v] = on_diagonal.x;
            entries[APSLK_LANES + v] = on_diagonal.y;
            entries[2 * APSLK_LANES + v] = on_diagonal.z;
            entries[3 * APSLK_LANES + v] = beside.x;
            entries[4 * APSLK_LANES + v] = beside.y;
            entries[5 * APSLK_LANES + v] = beside.z;
        }
        const apslk_symmetric sums = {private_lanes(entries, 0), private_lanes(entries, 1), private_lanes(entries, 2),
                                      private_lanes(entries, 3), private_lanes(entries, 4), private_lanes(entries, 5)};
        // A direction adds 1 to the trace, a gradient of zero nothing.
        const lanes unknown = private_lanes(gradients_around, 0) - (sums.xx + sums.yy + sums.zz);
        store_private_lanes(greatest_eigenvalue(sums) + fmax(unknown, (lanes)(0.0f)), bounds);
        for (uint v = 0; v < count; ++v) {
            const uint i = cloth.vertex_begin + first + v;
            // With a stretch ceiling the bound is that of the masses and triangles that are solved with.
            const bool raised = !APSLK_LIMITS_STRETCH && parameters[c].raises_masses && moved[i].w < motion[i].w;
            vertex_bounds[i] = (raised ? APSLK_RAISED_MARGIN : 1.0f) * bounds[v];
        }
    }
}
