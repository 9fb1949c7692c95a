// SPDX-License-Identifier: MIT
// One product of a Chebyshev solve, all of an iteration in a launch and no sum over the cloth:
//   y_{k+1} = y_k + a_k (y_k − y_{k−1}) + b_k (b̄ − J̄ J̄ᵀ y_k),   y₀ = 0,   y₁ = b̄/θ
// with b̄ the scaled right-hand side. Reference: apsl::reference::chebyshev.
// Moves, a triangle and with 1.1 for the patches' rims: 1.1 × (12 B corners, 2 + 2 B vertices, 24 B gradients, 4 B y)
// and 6 B local indices, 8 B of b̄ and y_{k−1} read, 4 B written. With a stretch ceiling each triangle has a second row,
// whose multiplier stays at or above zero; where it takes no part it costs nothing but looking.
#include "chebyshev.h"
#include "layout.h"
#include "limits_stretch.h"
#include "patch_product.h"
#include "work_group.h"

// All cloths share `launched` launches. A cloth that needs fewer skips the first ones, so that every cloth finishes in
// the last launch. `next` holds y_{k−1} and receives y_{k+1}.
APSLK_KERNEL void chebyshev_step(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                                 __global apslk_solve_state* states, __global const uint2* patches,
                                 __global const uint* patch_vertices, __global const ushort* local_triangles,
                                 __global const uint* corner_offsets, __global const uint* corners,
                                 __global const apslk_gradients* gradients, __global const float* right_hand_side,
                                 __global const float* current, __global float* next, int sub_step, int launched,
                                 int launch) {
    __local float4 forces[APSLK_PATCH_VERTICES];
    const uint c = (uint)get_group_id(1);
    const int products = min(chebyshev_products(parameters[c], sub_step), launched);
    const int k = launch - (launched - products) + 1;  // from 1 on
    const bool active = !states[c].stopped && k >= 1;
    const apslk_chebyshev_step step = chebyshev_coefficients(products + 1, k);
    __global const float* gathered = k == 1 ? right_hand_side : current;
    const float scale = k == 1 ? step.first : 1.0f, product_scale = scale * APSLK_GRADIENT_UNIT;
    // y₀ = 0 and y₁ come from the right-hand side, so that what a former solve left in `next` is never read.
    __global const float* before = k <= 2 ? right_hand_side : next;
    const float before_scale = k == 1 ? 0.0f : k == 2 ? step.first : 1.0f;

    const uint run = cloths[c].run;
    const apslk_patch_range range = patches_of(cloths[c], active);
    for (uint patch = range.begin; patch < range.end; ++patch) {
        const uint2 first = patches[patch], last = patches[patch + 1];
        gather_forces(first.y, last.y, patch_vertices, corner_offsets, corners, gradients, gathered, run, forces);
        group_barrier();
        for (uint a = first.x + (uint)get_local_id(0); a < last.x; a += APSLK_WORK_GROUP_SIZE) {
            APSLK_PREFETCH(gradients + a + APSLK_PREFETCH_TRIANGLES);
            APSLK_PREFETCH(gathered + a + APSLK_PREFETCH_TRIANGLES);
            const float b = right_hand_side[a];
            const float y = scale * gathered[a];
            const float q = product_scale * apply_to_forces(a, local_triangles, gradients, forces);
            next[a] = y + step.momentum * (y - before_scale * before[a]) + step.gain * (b - q);
#if APSLK_LIMITS_STRETCH
            if (has_stretch_row(gradients, a)) {
                const uint s = run + a;
                const float z = scale * fmax(gathered[s], 0.0f);
                const float earlier = before_scale * fmax(before[s], 0.0f);
                const float product = product_scale * apply_to_forces(a, local_triangles, gradients + run, forces);
                next[s] = fmax(z + step.momentum * (z - earlier) + step.gain * (right_hand_side[s] - product), 0.0f);
            } else if (k == products) {
                next[run + a] = 0.0f;  // for measure_area_change, which comes after the next assembly
            }
#endif
        }
        group_barrier();
    }
    if (active && get_group_id(0) == 0 && get_local_id(0) == 0) states[c].solve_iterations = k;
}
