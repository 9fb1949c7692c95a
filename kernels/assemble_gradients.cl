// SPDX-License-Identifier: MIT
// Areas, right-hand side of Eq. (5) and scaled corner gradients: everything a solve needs of the geometry, and the sums
// that decide whether there is a solve at all. Reference: apsl::reference, geometry, and the diagonal of Eq. (3).
// Moves 12 B indices, about 8 B positions, 4 B rest area read; 32 B gradients, 4 B residual, 4 B α D
// written, a triangle; in small steps 4 B start error read, with a stretch ceiling 8 B excesses read, 4 B
// written.
#include "layout.h"
#include "triangle_assembly.h"
#include "work_group.h"

// `for_solve`: 0 where the gradients are for a bound alone, and a second launch follows.
APSLK_KERNEL void assemble_gradients(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                                     __global const apslk_solve_state* states, __global float* partials,
                                     __global const uint* triangles, __global const float4* moved,
                                     __global apslk_gradients* gradients, __global float* residual,
                                     __global float* scaled_diagonal, __global const float* rest_areas,
                                     __global const float* regularization, __global float* start_errors, int sub_step,
                                     int for_solve) {
    APSLK_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const apslk_assembly_sums sums = assemble_triangles(
        cloths[c], !states[c].stopped, parameters[c].regularization,
        scheduled_damping(parameters[c].damping_step, parameters[c].sub_steps - 1 - sub_step),
        states[c].adaptive_factor, triangles, moved, gradients, residual, scaled_diagonal, rest_areas, regularization,
        small_step_count(parameters[c]), start_error_left(sub_step, small_step_count(parameters[c])), for_solve != 0,
        excess_asked_again(states[c].asked_sub_steps, parameters[c].sub_steps, parameters[c].most_sub_steps),
        start_errors);
    store_area_partials(sums.areas, partials, scratch);
    store_partial(partials, APSLK_PARTIAL_RESIDUAL_EVEN, group_sum(sum_of_lanes(sums.squares), scratch));
    store_partial(partials, APSLK_PARTIAL_SCALED_RESIDUAL_EVEN, group_sum(sum_of_lanes(sums.scaled_squares), scratch));
}
