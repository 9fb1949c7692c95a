// SPDX-License-Identifier: MIT
// The decisions of Algorithm 1, taken on the device by one work-group a cloth: begin a solve, end a call.
#include "layout.h"
#include "work_group.h"

// Area change over all triangles from the groups' partial results: greatest, and root of the mean square.
APSL_INLINE float2 area_change(__global float* partials, uint groups, __local float* scratch) {
    const float greatest = max_partials(partials, APSL_PARTIAL_MAX_CHANGE, groups, scratch);
    const float squared = sum_partials(partials, APSL_PARTIAL_SQUARED_CHANGE, groups, scratch);
    const float measured = sum_partials(partials, APSL_PARTIAL_MEASURED, groups, scratch);
    return (float2)(greatest, measured > 0.0f ? sqrt(squared / measured) : 0.0f);
}

// Algorithm 1, line 2: a sub-step is done unless the areas are at the target or something is not finite.
APSL_KERNEL void begin_solve(__global const apsl_parameters* parameters, __global apsl_solve_state* states,
                             __global apsl_stats* stats, __global float* partials, uint groups, int sub_step) {
    APSL_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const float greatest = max_partials(partials, APSL_PARTIAL_MAX_CHANGE, groups, scratch);
    const float not_finite = sum_partials(partials, APSL_PARTIAL_NOT_FINITE, groups, scratch);
    const float residual = sum_partials(partials, APSL_PARTIAL_RESIDUAL_EVEN, groups, scratch);
    if (get_local_id(0) != 0 || states[c].stopped) return;
    const bool broken = not_finite > 0.0f || !isfinite(residual);
    if (broken) stats[c].status = APSL_STATUS_DIVERGED;
    if (broken || sub_step >= parameters[c].sub_steps || greatest <= parameters[c].target_area_change) {
        states[c].stopped = 1;
    } else {
        states[c].solve_iterations = 0;
        states[c].initial_residual = residual;
        stats[c].sub_steps += 1;
    }
}

// Statistics of the areas the call leaves behind; a call that went wrong on the way leaves nothing behind.
APSL_KERNEL void end_call(__global apsl_stats* stats, __global float* partials, uint groups) {
    APSL_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const float2 change = area_change(partials, groups, scratch);
    const float not_finite = sum_partials(partials, APSL_PARTIAL_NOT_FINITE, groups, scratch);
    if (get_local_id(0) != 0) return;
    stats[c].max_area_change = change.x;
    stats[c].rms_area_change = change.y;
    if (not_finite > 0.0f) stats[c].status = APSL_STATUS_DIVERGED;
}
