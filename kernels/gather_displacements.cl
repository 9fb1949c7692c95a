// SPDX-License-Identifier: MIT
// Eq. (6) with λ = p Δt²: x_i −= w_i Σ_{a∋i} λ_a g_{a,i}, on to the next of small steps, and how the solve ended.
// Reference: apsl::reference, displacements, effective_masses and strain_limiter. Moves 12 B corners, 2 B offsets, 24 B
// gradients, 4 B pressure, 16 B position read and written, a triangle; in small steps 32 B and the 4 B of `stiffening`
// more, with contacts 36 B more a vertex, with accelerations 16 B, with tethers 8 B a tether and what its anchor takes.
#include "layout.h"
#include "regularization.h"
#include "vertex_motion.h"
#include "warm_start.h"
#include "work_group.h"

#ifndef APSLK_CHEBYSHEV
#define APSLK_CHEBYSHEV 0
#endif

APSLK_KERNEL void gather_displacements(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                                       __global apslk_solve_state* states, __global apslk_stats* stats,
                                       __global float* partials, __global const uint* corner_offsets,
                                       __global const uint* corners, __global const apslk_gradients* gradients,
                                       __global const float* pressure, __global float4* moved, __global float4* motion,
                                       __global float4* total_correction, __global const uint* vertex_order,
                                       __global const float* contacts, ulong contact_offset, int sub_step,
                                       uint slot APSLK_ACCELERATIONS_ARGUMENT APSLK_TETHERS_ARGUMENT) {
    APSLK_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const float initial = states[c].initial_squared_residual;
    // A right-hand side of zero does no iteration, and then, unless a guess was scaled by 0, no pressure is there to
    // read.
    const bool solved = APSLK_WARM_START_SUB_STEPS > 0 || states[c].solve_iterations > 0;
    const bool in_small_steps = small_step_count(parameters[c]) > 0;
    displace_vertices(cloths[c], !in_small_steps && !states[c].stopped && solved, corner_offsets, corners, gradients,
                      pressure, moved);
    const bool raises_masses = parameters[c].raises_masses != 0;
    apslk_free_part free = free_part(parameters + c, APSLK_ACCELERATIONS);
    // Of Δt times a velocity.
    free.gain *= parameters[c].time_step;
    free.duration *= parameters[c].time_step;
    const apslk_small_step small_step = {sub_step,
                                         small_step_count(parameters[c]),
                                         solved,
                                         raises_masses && sub_step + 1 < parameters[c].sub_steps,
                                         states[c].greatest_mass,
                                         raises_masses ? APSLK_HELD_TENSION : INFINITY};
    const apslk_touched touched = {contacts + contact_offset, vertex_order, parameters[c].time_step};
    const apslk_tethers tethers = APSLK_TETHERS_GIVEN;
    advance_vertices(cloths[c], in_small_steps && !states[c].stopped, small_step, free, corner_offsets, corners,
                     gradients, pressure, moved, motion, total_correction, touched, tethers);
    const float residual = sum_partials(partials, APSLK_PARTIAL_RESIDUAL_EVEN + slot, (uint)get_num_groups(0), scratch);
    if (get_group_id(0) == 0 && get_local_id(0) == 0 && !states[c].stopped) {
        // A polynomial is as long as it is, and nothing measures what it leaves.
        const bool measured = !APSLK_CHEBYSHEV;
        const bool converged = !measured || residual <= parameters[c].tolerance_squared * initial;
        states[c].adaptive_factor =
            adapted_factor(states[c].adaptive_factor, parameters[c], states[c].solve_iterations, converged);
        // The product with a guess costs as much as an iteration.
        stats[c].iterations += states[c].solve_iterations + (APSLK_WARM_START_SUB_STEPS > 0 ? 1 : 0);
        if (measured && initial > 0.0f)
            stats[c].residual = fmax(stats[c].residual, relative_residual(residual, initial));
        if (!converged && stats[c].status == APSLK_STATUS_OK) stats[c].status = APSLK_STATUS_NOT_CONVERGED;
    }
}
