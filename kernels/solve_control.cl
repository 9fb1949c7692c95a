// SPDX-License-Identifier: MIT
// The decisions of Algorithm 1, taken on the device by one work-group a cloth: judge the whole step, begin a solve, end
// a call. Reference: apsl::reference, strain_limiter.
#include "accept_or_reject.h"
#include "energy_bound.h"
#include "layout.h"
#include "limits_stretch.h"
#include "offender.h"
#include "small_steps.h"
#include "work_group.h"

// Area change over all triangles from the groups' partial results.
APSLK_INLINE apslk_area_change area_change(__global float* partials, uint groups, __local float* scratch) {
    const float greatest = max_partials(partials, APSLK_PARTIAL_MAX_CHANGE, groups, scratch);
    const float squared = sum_partials(partials, APSLK_PARTIAL_SQUARED_CHANGE, groups, scratch);
    const float capped = sum_partials(partials, APSLK_PARTIAL_CAPPED_CHANGE, groups, scratch);
    const float measured = sum_partials(partials, APSLK_PARTIAL_MEASURED, groups, scratch);
    apslk_area_change change = area_change_of(greatest, squared, capped, measured);
#if APSLK_LIMITS_STRETCH
    change.max_stretch = max_partials(partials, APSLK_PARTIAL_MAX_STRETCH, groups, scratch);
    change.max_excess = max_partials(partials, APSLK_PARTIAL_MAX_EXCESS, groups, scratch);
    const float squared_excess = sum_partials(partials, APSLK_PARTIAL_SQUARED_EXCESS, groups, scratch);
    change.rms_excess = measured > 0.0f ? sqrt(squared_excess / measured) : 0.0f;
#endif
    return change;
}

// Before small steps: the area change that the whole step would have, whether there is anything to do about it, the
// greatest effective mass, and with a stretch ceiling the number of sub-steps.
APSLK_KERNEL void judge_whole_step(__global apslk_parameters* parameters, __global apslk_solve_state* states,
                                   __global apslk_stats* stats, __global float* partials, uint groups) {
    APSLK_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const apslk_area_change change = area_change(partials, groups, scratch);
    const float not_finite = sum_partials(partials, APSLK_PARTIAL_NOT_FINITE, groups, scratch);
    const float log_masses = sum_partials(partials, APSLK_PARTIAL_LOG_MASSES, groups, scratch);
    const float movable = sum_partials(partials, APSLK_PARTIAL_MOVABLE, groups, scratch);
    if (get_local_id(0) != 0 || parameters[c].small_steps == 0) return;
    states[c].greatest_mass = greatest_effective_mass(log_masses, movable);
    store_initial(states + c, stats + c, change, !(not_finite > 0.0f));
    if (not_finite > 0.0f) stats[c].status = APSLK_STATUS_DIVERGED;
    // Where nothing is to be limited there still is bending.
    const bool met = !APSLK_ACTS_IN_PARTS && judged_max(change) <= parameters[c].target_area_change;
    if (not_finite > 0.0f || met) states[c].stopped = 1;
#if APSLK_LIMITS_STRETCH
    const int more =
        followed_sub_steps(change.max_excess, states[c].asked_sub_steps, parameters[c]) - parameters[c].sub_steps;
    parameters[c].sub_steps += more;
    parameters[c].small_steps += more;
#endif
}

// Algorithm 1, line 2: a sub-step is done unless the areas are at the target or something is not finite.
APSLK_KERNEL void begin_solve(__global const apslk_parameters* parameters, __global apslk_solve_state* states,
                              __global apslk_stats* stats, __global float* partials, uint groups, int sub_step) {
    APSLK_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const apslk_area_change change = area_change(partials, groups, scratch);
    const float not_finite = sum_partials(partials, APSLK_PARTIAL_NOT_FINITE, groups, scratch);
    const float residual = sum_partials(partials, APSLK_PARTIAL_RESIDUAL_EVEN, groups, scratch);
    if (get_local_id(0) != 0 || states[c].stopped) return;
    const int small_steps = parameters[c].small_steps;
    if (sub_step == 0 && small_steps == 0) store_initial(states + c, stats + c, change, !(not_finite > 0.0f));
    const bool broken = not_finite > 0.0f || !isfinite(residual);
    // On the way the areas are not those of the end of the step.
    const bool done = sub_step >= small_steps && judged_max(change) <= parameters[c].target_area_change;
    if (broken) stats[c].status = APSLK_STATUS_DIVERGED;
    if (broken || done || sub_step >= parameters[c].sub_steps) {
        states[c].stopped = 1;
    } else {
        states[c].solve_iterations = 0;
        states[c].initial_squared_residual = residual;
        stats[c].sub_steps += 1;
    }
}

// Statistics of the areas the call leaves behind; a call that went wrong on the way, or left the cloth worse than it
// was, leaves nothing behind.
APSLK_KERNEL void end_call(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                           __global apslk_solve_state* states, __global apslk_stats* stats, __global float* partials,
                           __global const uint* vertex_order, __global const uint* triangle_order,
                           __global const uint* triangles, __global const float4* moved,
                           __global const float* rest_areas, uint groups) {
    APSLK_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const apslk_area_change change = area_change(partials, groups, scratch);
    const bool bad_vertices = sum_partials(partials, APSLK_PARTIAL_BAD_VERTICES, groups, scratch) > 0.0f;
    const float not_finite = sum_partials(partials, APSLK_PARTIAL_NOT_FINITE, groups, scratch);
    const float extent = max_partials(partials, APSLK_PARTIAL_EXTENT, groups, scratch);
    const float raised = sum_partials(partials, APSLK_PARTIAL_RAISED, groups, scratch);
    const float mass_ratio = max_partials(partials, APSLK_PARTIAL_MASS_RATIO, groups, scratch);
#if APSLK_INTEGRATES
    const float free_energy = sum_partials(partials, APSLK_PARTIAL_FREE_ENERGY, groups, scratch);
    const float bent = sum_partials(partials, APSLK_PARTIAL_BENDING_ENERGY, groups, scratch);
    const float left_bent = sum_partials(partials, APSLK_PARTIAL_BENDING_LEFT, groups, scratch);
    const float left_energy = sum_partials(partials, APSLK_PARTIAL_LEFT_ENERGY, groups, scratch);
    const float gained_energy = sum_partials(partials, APSLK_PARTIAL_GAINED_ENERGY, groups, scratch);
    const float alone = sum_partials(partials, APSLK_PARTIAL_ADDED_ALONE, groups, scratch);
    const float along = sum_partials(partials, APSLK_PARTIAL_ADDED_ALONG, groups, scratch);
    const float pulling = sum_partials(partials, APSLK_PARTIAL_PULLING, groups, scratch);
    const float worst = max_partials(partials, APSLK_PARTIAL_WORST_MISS, groups, scratch);
#else
    (void)parameters;
#endif
#if APSLK_LIMITS_STRETCH
    const float stretch_rows = sum_partials(partials, APSLK_PARTIAL_STRETCH_ROWS, groups, scratch);
#endif
    const bool diverged = bad_vertices || not_finite > 0.0f || stats[c].status == APSLK_STATUS_DIVERGED;
    const bool none = stats[c].sub_steps == 0;
    if (none && get_local_id(0) == 0) store_initial(states + c, stats + c, change, !(not_finite > 0.0f));
    group_memory_barrier();
    const apslk_area_change initial = stored_initial(states + c, stats + c);
    const apslk_verdict verdict =
        judge(initial, change, greatest_change_at_rest(extent, change.measured, cloths[c].triangle_count));
    name_offender(stats + c, search_for(diverged, bad_vertices, verdict, judged_max(change)), cloths[c], vertex_order,
                  triangle_order, triangles, moved, rest_areas, scratch);
    group_memory_barrier();  // all have read the status
    if (get_local_id(0) != 0) return;
    store_area_change(stats + c, diverged || verdict.worse ? initial : change);
    if (verdict.rose) stats[c].status = APSLK_STATUS_WORSENED;
    if (diverged) stats[c].status = APSLK_STATUS_DIVERGED;
    states[c].discarded = diverged || verdict.worse || none;
#if APSLK_INTEGRATES
    const float gave = bending_given(bent, left_bent, parameters[c].small_steps);
    const apslk_energies energies = {free_energy + 2.0f * gave, states[c].pins * states[c].pins * states[c].mass,
                                     added_by_bodies(alone, along, pulling, states[c].mass), left_energy,
                                     gained_energy};
    const float allowed = allowed_energy(energies);
    const apslk_kept_shares kept = shares_kept_by_energy(energies, allowed, worst, states[c].flies);
    const bool slowed = !states[c].discarded && kept.speed * kept.gain < 1.0f;
    states[c].speed_kept = kept.speed;
    states[c].gain_kept = kept.gain;
#endif
    if (stats[c].status == APSLK_STATUS_OFF) return;
    stats[c].raised_vertices = (uint)raised;
    stats[c].greatest_mass_ratio = mass_ratio;
#if APSLK_INTEGRATES
    stats[c].energy_kept = slowed ? allowed / left_energy : 1.0f;
#else
    stats[c].energy_kept = 1.0f;
#endif
#if APSLK_LIMITS_STRETCH
    stats[c].stretch_rows = none ? 0u : (uint)stretch_rows;
    if (!diverged)
        states[c].asked_sub_steps = next_asked_sub_steps(states[c].asked_sub_steps, stats[c].sub_steps, mass_ratio);
#endif
}
