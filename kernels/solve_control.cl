// SPDX-License-Identifier: MIT
// The decisions of Algorithm 1, taken on the device by one work-group a cloth: begin a call, begin a solve, end a call.
// Reference: apsl::reference, strain_limiter.
#include "layout.h"
#include "never_worse.h"
#include "offender.h"
#include "work_group.h"

// Area change over all triangles from the groups' partial results: greatest, and root of the mean square.
APSL_INLINE float2 area_change(__global float* partials, uint groups, __local float* scratch) {
    const float greatest = max_partials(partials, APSL_PARTIAL_MAX_CHANGE, groups, scratch);
    const float squared = sum_partials(partials, APSL_PARTIAL_SQUARED_CHANGE, groups, scratch);
    const float measured = sum_partials(partials, APSL_PARTIAL_MEASURED, groups, scratch);
    return (float2)(greatest, measured > 0.0f ? sqrt(squared / measured) : 0.0f);
}

// Before a walk: the area change that the whole step would have, and whether there is anything to do about it.
APSL_KERNEL void begin_call(__global const apsl_parameters* parameters, __global apsl_solve_state* states,
                            __global apsl_stats* stats, __global float* partials, uint groups) {
    APSL_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const float2 change = area_change(partials, groups, scratch);
    const float not_finite = sum_partials(partials, APSL_PARTIAL_NOT_FINITE, groups, scratch);
    if (get_local_id(0) != 0 || parameters[c].walked == 0) return;
    stats[c].initial_max_area_change = change.x;
    stats[c].initial_rms_area_change = change.y;
    if (not_finite > 0.0f) stats[c].status = APSL_STATUS_DIVERGED;
    if (not_finite > 0.0f || change.x <= parameters[c].target_area_change) states[c].stopped = 1;
}

// Algorithm 1, line 2: a sub-step is done unless the areas are at the target or something is not finite.
APSL_KERNEL void begin_solve(__global const apsl_parameters* parameters, __global apsl_solve_state* states,
                             __global apsl_stats* stats, __global float* partials, uint groups, int sub_step) {
    APSL_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const float2 change = area_change(partials, groups, scratch);
    const float not_finite = sum_partials(partials, APSL_PARTIAL_NOT_FINITE, groups, scratch);
    const float residual = sum_partials(partials, APSL_PARTIAL_RESIDUAL_EVEN, groups, scratch);
    if (get_local_id(0) != 0 || states[c].stopped) return;
    const int walked = parameters[c].walked;
    if (sub_step == 0 && walked == 0) {
        stats[c].initial_max_area_change = change.x;
        stats[c].initial_rms_area_change = change.y;
    }
    const bool broken = not_finite > 0.0f || !isfinite(residual);
    // On the way the areas are not those of the end of the step.
    const bool done = sub_step >= walked && change.x <= parameters[c].target_area_change;
    if (broken) stats[c].status = APSL_STATUS_DIVERGED;
    if (broken || done || sub_step >= parameters[c].sub_steps) {
        states[c].stopped = 1;
    } else {
        states[c].solve_iterations = 0;
        states[c].initial_residual = residual;
        stats[c].sub_steps += 1;
    }
}

// Statistics of the areas the call leaves behind; a call that went wrong on the way, or left the cloth worse than it
// was, leaves nothing behind.
APSL_KERNEL void end_call(__global const apsl_cloth* cloths, __global apsl_solve_state* states,
                          __global apsl_stats* stats, __global float* partials, __global const uint* vertex_order,
                          __global const uint* triangle_order, __global const uint* triangles,
                          __global const float4* predicted, __global const float* rest_areas, uint groups) {
    APSL_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const float2 change = area_change(partials, groups, scratch);
    const bool bad_vertices = sum_partials(partials, APSL_PARTIAL_BAD_VERTICES, groups, scratch) > 0.0f;
    const float not_finite = sum_partials(partials, APSL_PARTIAL_NOT_FINITE, groups, scratch);
    const bool diverged = bad_vertices || not_finite > 0.0f || stats[c].status == APSL_STATUS_DIVERGED;
    name_offender(stats + c, diverged, bad_vertices, cloths[c], vertex_order, triangle_order, triangles, predicted,
                  rest_areas, scratch);
    group_memory_barrier();  // all have read the status
    if (get_local_id(0) != 0) return;
    if (stats[c].sub_steps == 0) {
        stats[c].initial_max_area_change = change.x;
        stats[c].initial_rms_area_change = change.y;
    }
    const bool worse = is_worse(stats + c, change.x, change.y);
    if (diverged) stats[c].status = APSL_STATUS_DIVERGED;
    states[c].discarded = diverged || worse || stats[c].sub_steps == 0;
}
