// SPDX-License-Identifier: MIT
// Conjugate Gradient inside one work-group: the same steps as matrix_free_apply_dot and cg_update, without launches in
// between. Reference: apsl::reference::conjugate_gradient.
#ifndef APSLK_SOLVE_IN_ONE_GROUP_H
#define APSLK_SOLVE_IN_ONE_GROUP_H

#include "cg_step.h"
#include "layout.h"
#include "patch_product.h"
#include "warm_start.h"
#include "work_group.h"

// A solve under way; the same in every work-item of the group.
typedef struct {
    int iterations;
    float initial_squared_residual;  // ‖b‖², m⁴
    float residual;                  // ‖r‖², m⁴
    float scaled_residual;           // r̄·r̄
    float previous_scaled_residual;
    float previous_step;
} apslk_solve;

APSLK_INLINE apslk_solve begin_solve_in_group(float squares, float scaled_squares) {
    const apslk_solve solve = {0, squares, squares, scaled_squares, 0.0f, 0.0f};
    return solve;
}

// Starts from the guess in `pressure` where `guessing`, and iterates until the tolerance is met or the
// iterations are used up. Parameters and cloth are read where they are needed: held all the way they would cost 16
// scalar registers.
APSLK_INLINE void iterate_in_group(apslk_solve* solve, bool guessing, __global const apslk_parameters* parameters,
                                   __global const apslk_cloth* cloth, __global const uint2* patches,
                                   __global const uint* patch_vertices, __global const ushort* local_triangles,
                                   __global const uint* corner_offsets, __global const uint* corners,
                                   __global const apslk_gradients* gradients, __global float* residual,
                                   __global const float* scaled_diagonal, __global float* product,
                                   __global float* direction, __global float* direction_product,
                                   __global float* pressure, __local float4* forces, __local float* scratch) {
    bool going_on = true;  // uniform, as is guessing
    while (guessing || (going_on && solve->iterations < parameters->max_iterations &&
                        solve->residual > parameters->tolerance_squared * solve->initial_squared_residual)) {
        const float curvature =
            group_sum(multiply_patches(*cloth, true, patches, patch_vertices, local_triangles, corner_offsets, corners,
                                       gradients, guessing ? pressure : residual, product, forces),
                      scratch);
        group_memory_barrier();
        if (guessing) {
            const float dot =
                group_sum(guess_dot(*cloth, true, (__global numbers*)residual, (__global numbers*)pressure), scratch);
            const float2 sums = scale_guess(*cloth, true, guess_scale(dot, curvature), (__global numbers*)residual,
                                            (__global const numbers*)scaled_diagonal, (__global const numbers*)product,
                                            (__global numbers*)pressure);
            solve->residual = group_sum(sums.x, scratch);
            solve->scaled_residual = group_sum(sums.y, scratch);
            group_memory_barrier();
            guessing = false;
            continue;
        }
        const float2 coefficients = cg_coefficients(solve->scaled_residual, curvature, solve->previous_scaled_residual,
                                                    solve->previous_step, solve->iterations);
        going_on = coefficients.x > 0.0f;
        const float2 sums = advance_cg(*cloth, going_on, coefficients.x, coefficients.y, solve->iterations == 0,
                                       (__global numbers*)residual, (__global const numbers*)scaled_diagonal,
                                       (__global const numbers*)product, (__global numbers*)direction,
                                       (__global numbers*)direction_product, (__global numbers*)pressure);
        const float squares = group_sum(sums.x, scratch), scaled_squares = group_sum(sums.y, scratch);
        group_memory_barrier();
        if (going_on) {
            solve->previous_scaled_residual = solve->scaled_residual;
            solve->previous_step = coefficients.x;
            solve->residual = squares;
            solve->scaled_residual = scaled_squares;
            solve->iterations += 1;
        }
    }
}

#endif
