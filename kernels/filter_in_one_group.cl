// SPDX-License-Identifier: MIT
// Algorithm 1 for cloths that are small or many: one work-group takes one cloth through the whole filter, all sub-steps
// in a single launch, and every sum that decides something stays in the group. The same steps as the other kernels, in
// the same order. Reference: apsl::reference::BasicStrainLimiter.
#include "accept_or_reject.h"
#include "cg_step.h"
#include "first_guess.h"
#include "layout.h"
#include "offender.h"
#include "patch_product.h"
#include "regularization.h"
#include "solve_in_one_group.h"
#include "triangle_assembly.h"
#include "vertex_motion.h"
#include "work_group.h"

APSL_KERNEL void filter_in_one_group(
    __global const apsl_cloth* cloths, __global const apsl_parameters* parameters, __global apsl_solve_state* states,
    __global apsl_stats* all_stats, __global const uint* vertex_order, __global const uint* triangle_order,
    __global const uint* triangles, __global const uint2* patches, __global const uint* patch_vertices,
    __global const ushort* local_triangles, __global const uint* corner_offsets, __global const uint* corners,
    __global float4* predicted, __global float4* motion, __global float4* correction,
    __global apsl_gradients* gradients, __global float* residual, __global float* damped_diagonal,
    __global float* product, __global float* direction, __global float* direction_product, __global float* pressure,
    __global float* ordered_rest_areas, __global float* ordered_regularization, __global float* start_errors,
    __global const float* positions, ulong position_offset, __global float* velocities, ulong velocity_offset,
    __global const float* inverse_masses, ulong inverse_mass_offset, __global const float* rest_areas,
    ulong rest_area_offset, __global const float* regularization, ulong regularization_offset, uint pressure_stride) {
    APSL_SCRATCH;
    __local float4 forces[APSL_PATCH_VERTICES];
    const uint c = (uint)get_group_id(1);
    __global apsl_stats* stats = all_stats + c;
    int sub_steps = 0, iterations = 0;
    float worst_residual = 0.0f, factor = states[c].adaptive_factor;
    float greatest_mass = 0.0f;  // kg
    bool broken = false, converged = true, started = false;

    const apsl_vertex_sums vertex_sums =
        predict_vertices(cloths[c], parameters[c].enabled, parameters[c].time_step, walked_sub_steps(parameters[c]) > 0,
                         vertex_order, predicted, motion, positions + position_offset, velocities + velocity_offset,
                         inverse_masses + inverse_mass_offset);
    const float bad_vertices = group_sum(vertex_sums.bad, scratch);
    const float root_masses = group_sum(vertex_sums.root_masses, scratch);
    const float extent = group_max(vertex_sums.extent, scratch);
    greatest_mass = greatest_effective_mass(root_masses, group_sum(vertex_sums.movable, scratch));
    order_values(cloths[c], parameters[c].enabled, triangle_order, ordered_rest_areas, ordered_regularization,
                 rest_areas + rest_area_offset, regularization + regularization_offset);
    apsl_area_change change, initial;
    float rest_area = 0.0f;  // m², on average
    float start_not_finite = 0.0f;
    // A cloth that is off goes round once, with no triangle.
    for (bool going_on = true; going_on;) {  // uniform: decided by sums over the group
        group_memory_barrier();
        const apsl_assembly_sums sums = assemble_triangles(
            cloths[c], parameters[c].enabled, parameters[c].regularization,
            scheduled_damping(parameters[c].damping_step, parameters[c].sub_steps - 1 - sub_steps), factor, triangles,
            predicted, gradients, residual, damped_diagonal, ordered_rest_areas, ordered_regularization,
            walked_sub_steps(parameters[c]) > 0,
            started ? start_error_left(sub_steps, walked_sub_steps(parameters[c])) : 0.0f, start_errors);
        const float squared_change = group_sum(sum_of_lanes(sums.areas.squared_change), scratch);
        const float capped_change = group_sum(sum_of_lanes(sums.areas.capped_change), scratch);
        const float measured = group_sum(sum_of_lanes(sums.areas.measured), scratch);
        const float not_finite = group_sum(sum_of_lanes(sums.areas.not_finite), scratch) + start_not_finite;
        apsl_solve solve = begin_solve_in_group(group_sum(sum_of_lanes(sums.squares), scratch),
                                                group_sum(sum_of_lanes(sums.scaled_squares), scratch));
        change = area_change_of(group_max(max_of_lanes(sums.areas.max_change), scratch), squared_change, capped_change,
                                measured);
        broken = not_finite > 0.0f || !isfinite(solve.initial_residual);
        const bool on_the_way = started && sub_steps < walked_sub_steps(parameters[c]);
        going_on = !broken && sub_steps < parameters[c].sub_steps &&
                   (on_the_way || change.max > parameters[c].target_area_change);
        rest_area = measured / (float)cloths[c].triangle_count;
        if (!started) initial = broken ? area_change_of(0.0f, 0.0f, 0.0f, 0.0f) : change;
        // On a walk the first round only looks at its end; the second assembles where it begins.
        const bool starting = !started && going_on && walked_sub_steps(parameters[c]) > 0;
        started = true;
        group_memory_barrier();
        if (starting) {  // uniform
            start_not_finite = group_sum(
                sum_of_lanes(find_start_errors(cloths[c], true, triangles, motion, ordered_rest_areas, start_errors)),
                scratch);
            group_memory_barrier();
        }
        start_walking(cloths[c], starting, parameters[c].time_step, walked_sub_steps(parameters[c]), vertex_order,
                      predicted, motion, correction, velocities + velocity_offset);
        if (going_on && !starting) {
            if (APSL_KEPT_PRESSURES > 0) {
                copy_pressures(cloths[c], pressure, pressure + kept_place(sub_steps, pressure_stride));
                iterations += 1;  // the product with a guess costs as much
                group_memory_barrier();
            }
            iterate_in_group(&solve, APSL_KEPT_PRESSURES > 0, parameters + c, cloths + c, patches, patch_vertices,
                             local_triangles, corner_offsets, corners, gradients, residual, damped_diagonal, product,
                             direction, direction_product, pressure, forces, scratch);
            if (APSL_KEPT_PRESSURES > 0)
                copy_pressures(cloths[c], pressure + kept_place(sub_steps, pressure_stride), pressure);
            const bool solved = APSL_KEPT_PRESSURES > 0 || solve.iterations > 0;
            const bool walking = walked_sub_steps(parameters[c]) > 0;
            const bool raises_masses = parameters[c].raises_masses != 0;
            const apsl_walk walk = {sub_steps,
                                    walked_sub_steps(parameters[c]),
                                    solved,
                                    raises_masses,
                                    raises_masses && sub_steps + 1 < parameters[c].sub_steps,
                                    greatest_mass};
            displace_vertices(cloths[c], solved && !walking, corner_offsets, corners, gradients, pressure, predicted);
            walk_vertices(cloths[c], walking, walk, corner_offsets, corners, gradients, pressure, predicted, motion,
                          correction);
            const bool met = solve.residual <= parameters[c].tolerance_squared * solve.initial_residual;
            factor = adapted_factor(factor, parameters[c], solve.iterations, met);
            converged = converged && met;
            sub_steps += 1;
            iterations += solve.iterations;
            if (solve.initial_residual > 0.0f)
                worst_residual = fmax(worst_residual, relative_residual(solve.residual, solve.initial_residual));
        }
    }
    broken = broken || bad_vertices > 0.0f;
    const apsl_raised_masses raised = raised_masses(cloths[c], parameters[c].raises_masses, predicted, motion);
    const float raised_vertices = group_sum(raised.count, scratch);
    const float mass_ratio = group_max(raised.greatest_ratio, scratch);
    const apsl_verdict verdict = judge(initial, change, at_rest_up_to(extent, rest_area));
    if (get_local_id(0) == 0) {
        const bool off = !parameters[c].enabled;
        states[c].adaptive_factor = factor;
        stats->sub_steps = sub_steps;
        stats->cg_iterations = iterations;
        stats->residual = worst_residual;
        stats->initial_max_area_change = initial.max;
        stats->initial_rms_area_change = initial.rms;
        store_area_change(stats, broken || verdict.worse ? initial : change);
        stats->status = off            ? APSL_STATUS_OFF
                        : broken       ? APSL_STATUS_DIVERGED
                        : verdict.rose ? APSL_STATUS_WORSENED
                        : converged    ? APSL_STATUS_OK
                                       : APSL_STATUS_NOT_CONVERGED;
        stats->raised_vertices = off ? 0u : (uint)raised_vertices;
        stats->greatest_mass_ratio = off ? 0.0f : mass_ratio;
        states[c].discarded = broken || verdict.worse || sub_steps == 0;
    }
    group_memory_barrier();
    name_offender(stats, search_for(broken, bad_vertices > 0.0f, verdict, change.max), cloths[c], vertex_order,
                  triangle_order, triangles, predicted, ordered_rest_areas, scratch);
    store_corrections(cloths[c], !states[c].discarded, parameters[c].time_step, walked_sub_steps(parameters[c]) > 0,
                      vertex_order, predicted, correction, positions + position_offset, velocities + velocity_offset);
}
