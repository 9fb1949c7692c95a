// SPDX-License-Identifier: MIT
// The vector part of a CG iteration, all of it in one pass. Reference: apsl::reference::conjugate_gradient.
// Moves r, q, p, s, y, α D read, r, p, s, y written: 40 B a triangle.
#include "conjugate_gradient.h"
#include "layout.h"
#include "work_group.h"

// Chronopoulos and Gear: β = γ_k / γ_{k−1}, α = γ_k / (δ_k − β γ_k / α_{k−1}). Step 0 where the matrix shows no
// curvature above rounding along the direction (α = 1 can bring that about): the solve then stays where it is, for
// good, since a former step of 0 makes the denominator −∞.
static inline __attribute__((always_inline)) float2 cg_coefficients(float residual, float curvature,
                                                                    float previous_residual, float previous_step,
                                                                    int iteration) {
    const float beta = iteration == 0 ? 0.0f : residual / previous_residual;
    const float denominator = iteration == 0 ? curvature : curvature - beta * residual / previous_step;
    const float step = residual / denominator;
    const bool usable = denominator > FLT_EPSILON * residual && isfinite(step) && isfinite(beta);
    return usable ? (float2)(step, beta) : (float2)(0.0f, 0.0f);
}

// Stores a partial sum for the next iteration. A solve that has ended hands its last one on, so that both slots hold
// it.
static inline __attribute__((always_inline)) void store_or_hand_on(__global float* partials, uint even_kind, uint slot,
                                                                   bool iterating, float sum) {
    const uint groups = (uint)get_num_groups(0), group = (uint)get_group_id(0);
    const float last = partials_of(partials, even_kind + slot, groups)[group];
    partials_of(partials, even_kind + (slot ^ 1u), groups)[group] = iterating ? sum : last;
}

APSL_KERNEL void cg_update(__global const apsl_cloth* cloths, __global apsl_solve_state* states,
                           __global apsl_stats* stats, __global float* partials, __global float4* residual,
                           __global const float4* damped_diagonal, __global const float4* product,
                           __global float4* direction, __global float4* direction_product, __global float4* pressure,
                           int iteration) {
    APSL_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const apsl_cloth cloth = cloths[c];
    const uint groups = (uint)get_num_groups(0);
    const uint slot = (uint)iteration & 1u;
    const float curvature = sum_partials(partials, APSL_PARTIAL_CURVATURE, groups, scratch);
    const float2 coefficients =
        cg_coefficients(states[c].scaled_residual[slot], curvature, states[c].scaled_residual[slot ^ 1u],
                        states[c].step[slot ^ 1u], iteration);
    const float step = coefficients.x, beta = coefficients.y;
    const bool iterating = states[c].iterating && step > 0.0f;

    const uint begin = cloth.triangle_begin / 4u;
    const apsl_range range = share_of((cloth.triangle_count + 3u) / 4u, iterating);
    float4 squares = (float4)(0.0f), scaled_squares = (float4)(0.0f);
    for (uint n = range.first; n < range.end; n += APSL_WORK_GROUP_SIZE) {
        const uint i = begin + n;
        const float4 q = product[i];
        float4 r = residual[i], p = r, s = q, y = (float4)(0.0f);
        if (iteration != 0) {  // uniform; what a former solve left behind is never read
            p += beta * direction[i];
            s += beta * direction_product[i];
            y = pressure[i];
        }
        y += step * p;
        r -= step * s;
        direction[i] = p;
        direction_product[i] = s;
        pressure[i] = y;
        residual[i] = r;
        squares += r * r * damped_diagonal[i];
        scaled_squares += r * r;
    }
    const float sum = group_sum(squares.x + squares.y + squares.z + squares.w, scratch);
    const float scaled_sum =
        group_sum(scaled_squares.x + scaled_squares.y + scaled_squares.z + scaled_squares.w, scratch);

    if (get_local_id(0) == 0) {
        store_or_hand_on(partials, APSL_PARTIAL_RESIDUAL_EVEN, slot, iterating, sum);
        store_or_hand_on(partials, APSL_PARTIAL_SCALED_RESIDUAL_EVEN, slot, iterating, scaled_sum);
        if (get_group_id(0) == 0 && states[c].iterating) states[c].step[slot] = step;
        if (get_group_id(0) == 0 && iterating) {
            states[c].has_pressure = 1;
            stats[c].cg_iterations += 1;
        }
    }
}
