// SPDX-License-Identifier: MIT
// Algorithm 1 for cloths that are small or many: one work-group takes one cloth through the whole filter, all sub-steps
// in a single launch, and every sum that decides something stays in the group. The same steps as the other kernels, in
// the same order. Reference: apsl::reference::BasicStrainLimiter.
#include "accept_or_reject.h"
#include "cg_step.h"
#include "layout.h"
#include "offender.h"
#include "patch_product.h"
#include "regularization.h"
#include "solve_in_one_group.h"
#include "triangle_assembly.h"
#include "vertex_motion.h"
#include "warm_start.h"
#include "work_group.h"

APSLK_KERNEL void filter_in_one_group(
    __global const apslk_cloth* cloths, __global const apslk_parameters* parameters, __global apslk_solve_state* states,
    __global apslk_stats* all_stats, __global const uint* vertex_order, __global const uint* triangle_order,
    __global const uint* triangles, __global const uint2* patches, __global const uint* patch_vertices,
    __global const ushort* local_triangles, __global const uint* corner_offsets, __global const uint* corners,
    __global float4* moved, __global float4* motion, __global float4* total_correction,
    __global apslk_gradients* gradients, __global float* residual, __global float* scaled_diagonal,
    __global float* product, __global float* direction, __global float* direction_product, __global float* pressure,
    __global float* ordered_rest_areas, __global float* ordered_scaling, __global float* start_errors,
    __global const float* positions, ulong position_offset, __global float* velocities, ulong velocity_offset,
    __global const float* inverse_masses, ulong inverse_mass_offset, __global const float* rest_areas,
    ulong rest_area_offset, __global const float* regularization, ulong regularization_offset, uint pressure_stride) {
    assume_one_group();
    APSLK_SCRATCH;
    __local float4 forces[APSLK_PATCH_VERTICES];
    const uint c = (uint)get_group_id(1);
    __global apslk_stats* stats = all_stats + c;
    const apslk_touched nothing_touched = {0, vertex_order, 0.0f};
    const apslk_tethers no_tethers = APSLK_NO_TETHERS;
    int sub_steps = 0;
    bool started = false;

    const apslk_vertex_sums vertex_sums =
        predict_vertices(cloths[c], parameters[c].enabled, parameters[c].time_step, free_step(parameters + c, 0),
                         small_step_count(parameters[c]) > 0, vertex_order, moved, motion, positions + position_offset,
                         velocities + velocity_offset, inverse_masses + inverse_mass_offset, 0);
    const float bad_vertices = group_sum(vertex_sums.bad, scratch);
    const float log_masses = group_sum(vertex_sums.log_masses, scratch);
    const float extent = group_max(vertex_sums.extent, scratch);
    const float greatest_mass = greatest_effective_mass(log_masses, group_sum(vertex_sums.movable, scratch));
    // What only a few places need is in memory: the loop has no registers to spare.
    if (get_local_id(0) == 0) {
        states[c].greatest_mass = greatest_mass;
        states[c].extent = extent;
        stats->iterations = 0;
        stats->residual = 0.0f;
        stats->status = APSLK_STATUS_OK;
        stats->offender = bad_vertices > 0.0f ? APSLK_OFFENDER_VERTEX : APSLK_OFFENDER_NONE;
    }
    order_values(cloths[c], parameters[c].enabled, triangle_order, ordered_rest_areas, ordered_scaling,
                 rest_areas + rest_area_offset, regularization + regularization_offset);
    group_memory_barrier();
    const bool takes_small_steps = small_step_count(parameters[c]) > 0;
    const float start_not_finite = group_sum(sum_of_lanes(find_start_errors(cloths[c], takes_small_steps, triangles,
                                                                            motion, ordered_rest_areas, start_errors)),
                                             scratch);
    if (start_not_finite > 0.0f && get_local_id(0) == 0) stats->status = APSLK_STATUS_DIVERGED;
    float capped_rms = 0.0f;
    // A cloth that is off goes round once, with no triangle.
    for (bool going_on = true; going_on;) {  // uniform: decided by sums over the group
        group_memory_barrier();
        const apslk_assembly_sums sums = assemble_triangles(
            cloths[c], parameters[c].enabled, parameters[c].regularization,
            scheduled_damping(parameters[c].damping_step, parameters[c].sub_steps - 1 - sub_steps),
            states[c].adaptive_factor, triangles, moved, gradients, residual, scaled_diagonal, ordered_rest_areas,
            ordered_scaling, small_step_count(parameters[c]),
            started ? start_error_left(sub_steps, small_step_count(parameters[c])) : 0.0f, true, 0.0f, start_errors);
        const apslk_area_change change = area_change_in_group(sums.areas, scratch);
        const float not_finite = group_sum(sum_of_lanes(sums.areas.not_finite), scratch);
        apslk_solve solve = begin_solve_in_group(group_sum(sum_of_lanes(sums.squares), scratch),
                                                 group_sum(sum_of_lanes(sums.scaled_squares), scratch));
        const bool broken =
            stats->status == APSLK_STATUS_DIVERGED || not_finite > 0.0f || !isfinite(solve.initial_squared_residual);
        capped_rms = change.capped_rms;
        const bool on_the_way = started && sub_steps < small_step_count(parameters[c]);
        going_on = !broken && sub_steps < parameters[c].sub_steps &&
                   (on_the_way || change.max > parameters[c].target_area_change);
        // In small steps the first round only looks at its end; the second assembles where it begins.
        const bool starting = !started && going_on && small_step_count(parameters[c]) > 0;
        group_memory_barrier();
        if (get_local_id(0) == 0) {
            if (!started) store_initial(states + c, stats, change, !broken);
            states[c].measured = change.measured;
            store_area_change(stats, change);
            if (broken) stats->status = APSLK_STATUS_DIVERGED;
        }
        started = true;
        // Not under a condition: where a loop follows a conditional barrier, pocl 3.1 lets the first work-item decide
        // for all whether to enter it.
        begin_small_steps(cloths[c], starting, parameters[c].time_step, free_part(parameters + c, 0),
                          small_step_count(parameters[c]), vertex_order, moved, motion, total_correction,
                          velocities + velocity_offset, no_tethers);
        if (going_on && !starting) {
            if (APSLK_WARM_START_SUB_STEPS > 0) {
                copy_pressures(cloths[c], pressure, pressure + kept_place(sub_steps, pressure_stride));
                group_memory_barrier();
            }
            iterate_in_group(&solve, APSLK_WARM_START_SUB_STEPS > 0, parameters + c, cloths + c, patches,
                             patch_vertices, local_triangles, corner_offsets, corners, gradients, residual,
                             scaled_diagonal, product, direction, direction_product, pressure, forces, scratch);
            if (APSLK_WARM_START_SUB_STEPS > 0)
                copy_pressures(cloths[c], pressure + kept_place(sub_steps, pressure_stride), pressure);
            const bool solved = APSLK_WARM_START_SUB_STEPS > 0 || solve.iterations > 0;
            const bool in_small_steps = small_step_count(parameters[c]) > 0;
            const bool raises_masses = parameters[c].raises_masses != 0;
            const apslk_small_step small_step = {sub_steps,
                                                 small_step_count(parameters[c]),
                                                 solved,
                                                 raises_masses && sub_steps + 1 < parameters[c].sub_steps,
                                                 states[c].greatest_mass,
                                                 raises_masses ? APSLK_HELD_TENSION : INFINITY};
            if (in_small_steps)  // uniform
                advance_vertices(cloths[c], true, small_step, free_part(parameters + c, 0), corner_offsets, corners,
                                 gradients, pressure, moved, motion, total_correction, nothing_touched, no_tethers);
            else
                displace_vertices(cloths[c], solved, corner_offsets, corners, gradients, pressure, moved);
            const bool met = solve.residual <= parameters[c].tolerance_squared * solve.initial_squared_residual;
            if (get_local_id(0) == 0) {
                states[c].adaptive_factor =
                    adapted_factor(states[c].adaptive_factor, parameters[c], solve.iterations, met);
                // The product with a guess costs as much.
                stats->iterations += solve.iterations + (APSLK_WARM_START_SUB_STEPS > 0 ? 1 : 0);
                if (!met) stats->status = APSLK_STATUS_NOT_CONVERGED;
                if (solve.initial_squared_residual > 0.0f)
                    stats->residual =
                        fmax(stats->residual, relative_residual(solve.residual, solve.initial_squared_residual));
            }
            sub_steps += 1;
        }
    }
    group_memory_barrier();
    const bool bad_vertex = stats->offender == APSLK_OFFENDER_VERTEX;
    const bool broken = bad_vertex || stats->status == APSLK_STATUS_DIVERGED;
    const apslk_raised_masses raised = raised_masses(cloths[c], parameters[c].raises_masses, moved, motion);
    const float raised_vertices = group_sum(raised.count, scratch);
    const float mass_ratio = group_max(raised.greatest_ratio, scratch);
    const apslk_area_change initial = stored_initial(states + c, stats);
    const apslk_area_change change = {stats->max_area_change, stats->rms_area_change, capped_rms, states[c].measured};
    const apslk_verdict verdict =
        judge(initial, change, greatest_change_at_rest(states[c].extent, states[c].measured, cloths[c].triangle_count));
    group_memory_barrier();  // all have read the statistics
    if (get_local_id(0) == 0) {
        const bool off = !parameters[c].enabled;
        stats->sub_steps = sub_steps;
        store_area_change(stats, broken || verdict.worse ? initial : change);
        if (verdict.rose) stats->status = APSLK_STATUS_WORSENED;
        if (broken) stats->status = APSLK_STATUS_DIVERGED;
        if (off) stats->status = APSLK_STATUS_OFF;
        stats->raised_vertices = off ? 0u : (uint)raised_vertices;
        stats->greatest_mass_ratio = off ? 0.0f : mass_ratio;
        stats->energy_kept = off ? 0.0f : 1.0f;
        states[c].discarded = broken || verdict.worse || sub_steps == 0;
    }
    group_memory_barrier();
    name_offender(stats, search_for(broken, bad_vertex, verdict, change.max), cloths[c], vertex_order, triangle_order,
                  triangles, moved, ordered_rest_areas, scratch);
    const bool limited = !states[c].discarded;
    store_corrections(cloths[c], limited, limited, parameters[c].time_step, small_step_count(parameters[c]) > 0,
                      vertex_order, moved, total_correction, positions + position_offset, velocities + velocity_offset,
                      0);
}
