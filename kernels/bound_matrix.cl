// SPDX-License-Identifier: MIT
// A diagonal that bounds the matrix: G ≼ diag(ρ D), ρ_a D_a = Σ_{i∈a} σ_i, with σ_i the greatest eigenvalue of
// ½ w_i Σ_{a∋i} g gᵀ, or a little more. From the gradients of the last sub-step, scaled by 1/√(ρ D) with the ρ there
// was. Reference: apsl::reference::diagonal_bound.
#include "gradients.h"
#include "lanes.h"
#include "layout.h"
#include "work_group.h"

// What the bound is multiplied by: it is that of a sub-step before, and the cloth goes on moving.
#define APSL_BOUND_MARGIN 1.1f
// Of a triangle that had no extent, and may get any.
#define APSL_UNKNOWN_BOUND 16.0f

// Symmetric 3×3 matrices.
typedef struct {
    lanes xx, yy, zz, xy, xz, yz;
} apsl_symmetric;

APSL_INLINE apsl_symmetric squared(apsl_symmetric m) {
    apsl_symmetric s;
    s.xx = m.xx * m.xx + m.xy * m.xy + m.xz * m.xz;
    s.yy = m.xy * m.xy + m.yy * m.yy + m.yz * m.yz;
    s.zz = m.xz * m.xz + m.yz * m.yz + m.zz * m.zz;
    s.xy = m.xy * (m.xx + m.yy) + m.xz * m.yz;
    s.xz = m.xz * (m.xx + m.zz) + m.xy * m.yz;
    s.yz = m.yz * (m.yy + m.zz) + m.xy * m.xz;
    return s;
}

// (Σ λ³²)^(1/32) over the eigenvalues, none below 0: the greatest, or up to 1.04 times that.
APSL_INLINE lanes greatest_eigenvalue(apsl_symmetric m) {
    const lanes trace = m.xx + m.yy + m.zz;
    const lanes inverse = select((lanes)(0.0f), 1.0f / trace, trace > 0.0f);
    m.xx *= inverse;
    m.yy *= inverse;
    m.zz *= inverse;
    m.xy *= inverse;
    m.xz *= inverse;
    m.yz *= inverse;
    const apsl_symmetric p = squared(squared(squared(squared(m))));
    const lanes sum = p.xx * p.xx + p.yy * p.yy + p.zz * p.zz + 2.0f * (p.xy * p.xy + p.xz * p.xz + p.yz * p.yz);
    return trace * sqrt(sqrt(sqrt(sqrt(sqrt(sum)))));
}

// σ_i. Moves 12 B corners, 2 B offsets, 24 B gradients, 4 B ρ D read, 2 B written, a triangle.
APSL_KERNEL void bound_vertices(__global const apsl_cloth* cloths, __global const apsl_solve_state* states,
                                __global const uint* corner_offsets, __global const uint* corners,
                                __global const apsl_gradients* gradients, __global const float* bounded_diagonal,
                                __global float* vertex_bound) {
    const uint c = (uint)get_group_id(1);
    const apsl_cloth cloth = cloths[c];
    const apsl_range range = share_of((cloth.vertex_count + APSL_LANES - 1u) / APSL_LANES, !states[c].stopped);
    for (uint block = range.first; block < range.end; block += APSL_WORK_GROUP_SIZE) {
        const uint first = block * APSL_LANES;
        const uint count = min((uint)APSL_LANES, cloth.vertex_count - first);
        float entries[6 * APSL_LANES] = {0.0f}, greatest[APSL_LANES];
        for (uint v = 0; v < count; ++v) {
            const uint i = cloth.vertex_begin + first + v;
            float4 on_diagonal = (float4)(0.0f), beside = (float4)(0.0f);
            const uint end = corner_offsets[i + 1];
            for (uint n = corner_offsets[i]; n < end; ++n) {
                const float4 g = APSL_GRADIENT_UNIT * corner_gradient(gradients, corners[n]);
                const float4 scaled = bounded_diagonal[APSL_CORNER_TRIANGLE(corners[n])] * g;
                on_diagonal += scaled * g;
                beside += scaled.xxyw * g.yzzw;
            }
            entries[v] = on_diagonal.x;
            entries[APSL_LANES + v] = on_diagonal.y;
            entries[2 * APSL_LANES + v] = on_diagonal.z;
            entries[3 * APSL_LANES + v] = beside.x;
            entries[4 * APSL_LANES + v] = beside.y;
            entries[5 * APSL_LANES + v] = beside.z;
        }
        const apsl_symmetric sums = {private_lanes(entries, 0), private_lanes(entries, 1), private_lanes(entries, 2),
                                     private_lanes(entries, 3), private_lanes(entries, 4), private_lanes(entries, 5)};
        store_private_lanes(greatest_eigenvalue(sums), greatest);
        for (uint v = 0; v < count; ++v) vertex_bound[cloth.vertex_begin + first + v] = greatest[v];
    }
}

// ρ_a with its margin. Moves 12 B indices, 2 B of σ, 4 B ρ D and 4 B ρ read, 4 B written, a triangle.
APSL_KERNEL void bound_triangles(__global const apsl_cloth* cloths, __global const apsl_solve_state* states,
                                 __global const uint* triangles, __global const float* bounded_diagonal,
                                 __global const float* vertex_bound, __global float* bound) {
    const uint c = (uint)get_group_id(1);
    const apsl_cloth cloth = cloths[c];
    const apsl_range range = share_of(cloth.triangle_count, !states[c].stopped);
    for (uint t = range.first; t < range.end; t += APSL_WORK_GROUP_SIZE) {
        const uint a = cloth.triangle_begin + t;
        const float sum = vertex_bound[triangles[3u * a]] + vertex_bound[triangles[3u * a + 1u]] +
                          vertex_bound[triangles[3u * a + 2u]];
        const float diagonal = bounded_diagonal[a] / bound[a];
        bound[a] = diagonal > 0.0f ? APSL_BOUND_MARGIN * sum / diagonal : APSL_UNKNOWN_BOUND;
    }
}
