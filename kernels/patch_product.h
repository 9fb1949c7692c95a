// SPDX-License-Identifier: MIT
// Products with the consistent matrix without assembling it, A = J̄ J̄ᵀ + diag((α − 1)/α): a work-group takes a patch of
// triangles at a time, gathers the forces u = J̄ᵀ r on the patch's vertices into local memory, and applies J̄ from there.
// Vertices on a patch's rim are gathered by every patch they belong to.
// Reference: apsl::reference::consistent_matrix times a vector.
#ifndef APSLK_PATCH_PRODUCT_H
#define APSLK_PATCH_PRODUCT_H

#include "gradients.h"
#include "layout.h"
#include "vertex_gather.h"
#include "work_group.h"

#ifndef APSLK_PATCH_VERTICES
#define APSLK_PATCH_VERTICES 1024
#endif

// A CPU's core works through patches one after another: while it multiplies one, the gradients and residuals of the
// next come into its cache. The gather jumps about in them, which the hardware's own prefetching cannot follow.
#if APSLK_WORK_GROUP_SIZE == 1 && defined(__has_builtin) && !defined(APSLK_PREFETCH)
#if __has_builtin(__builtin_prefetch)
#define APSLK_PREFETCH(address) __builtin_prefetch((const void*)(size_t)(address))
#endif
#endif
#ifndef APSLK_PREFETCH
#define APSLK_PREFETCH(address)
#endif
#define APSLK_PREFETCH_TRIANGLES 2048

// The patches of this work-group, from `begin` up to `end`.
typedef struct {
    uint begin, end;
} apslk_patch_range;

// Where there are fewer patches than groups, the groups without one lie between the others: pocl gives a thread
// neighbouring groups, and each thread is to have as many patches.
APSLK_INLINE apslk_patch_range patches_of(apslk_cloth cloth, bool active) {
    const uint groups = (uint)get_num_groups(0), group = (uint)get_group_id(0);
    const uint each = cloth.patch_count / groups, left = cloth.patch_count % groups;
    const uint begin = cloth.patch_begin + group * each + group * left / groups;
    const uint end = cloth.patch_begin + (group + 1u) * each + (group + 1u) * left / groups;
    const apslk_patch_range range = {begin, active ? end : begin};
    return range;
}

// u = J̄ᵀ r on the vertices of a patch, those between `first` and `last` in patch_vertices. `run`: of the arrays of
// rows.
APSLK_INLINE void gather_forces(uint first, uint last, __global const uint* patch_vertices,
                                __global const uint* corner_offsets, __global const uint* corners,
                                __global const apslk_gradients* gradients, __global const float* values, uint run,
                                __local float4* forces) {
    for (uint n = first + (uint)get_local_id(0); n < last; n += APSLK_WORK_GROUP_SIZE)
        forces[n - first] = sum_over_corners(corner_offsets, corners, gradients, values, run, patch_vertices[n]);
}

// (J̄ u)_a in units of APSLK_GRADIENT_UNIT.
APSLK_INLINE float apply_to_forces(uint a, __global const ushort* local_triangles,
                                   __global const apslk_gradients* gradients, __local const float4* forces) {
    const ushort3 v = vload3(a, local_triangles);
    const float4 terms = corner_gradient(gradients, 4u * a) * forces[v.x] +
                         corner_gradient(gradients, 4u * a + 1u) * forces[v.y] +
                         corner_gradient(gradients, 4u * a + 2u) * forces[v.z];
    const float2 halves = terms.lo + terms.hi;
    return halves.x + halves.y;
}

// q = A r; this work-item's part of r·q.
APSLK_INLINE float multiply_patches(apslk_cloth cloth, bool active, __global const uint2* patches,
                                    __global const uint* patch_vertices, __global const ushort* local_triangles,
                                    __global const uint* corner_offsets, __global const uint* corners,
                                    __global const apslk_gradients* gradients, __global const float* residual,
                                    __global float* product, __local float4* forces) {
    const apslk_patch_range range = patches_of(cloth, active);
    float curvature = 0.0f;
    for (uint patch = range.begin; patch < range.end; ++patch) {
        const uint2 first = patches[patch], last = patches[patch + 1];
        gather_forces(first.y, last.y, patch_vertices, corner_offsets, corners, gradients, residual, cloth.run, forces);
        group_barrier();
        for (uint a = first.x + (uint)get_local_id(0); a < last.x; a += APSLK_WORK_GROUP_SIZE) {
            APSLK_PREFETCH(gradients + a + APSLK_PREFETCH_TRIANGLES);
            APSLK_PREFETCH(residual + a + APSLK_PREFETCH_TRIANGLES);
            const float r = residual[a];
            const float q =
                APSLK_GRADIENT_UNIT * apply_to_forces(a, local_triangles, gradients, forces) + gradients[a].shift * r;
            product[a] = q;
            curvature += r * q;
        }
        group_barrier();
    }
    return curvature;
}

#endif
