// SPDX-License-Identifier: MIT
#pragma once

#include "kernel_launch.hpp"

#include <apsl/strain_limiter.hpp>

namespace apsl::host {

/// A limiter's kernels by their names. What the options do not need is empty.
struct LimiterKernels {
    Kernel set_parameters, rest_areas;
    Kernel filter_in_one_group;
    Kernel predict_positions, order_triangle_values, measure_step, judge_whole_step, start_small_steps,
        assemble_gradients, begin_solve, gather_displacements, measure_area_change, end_call, update_velocities,
        measure_energy, store_step;
    Kernel assemble_pressure_csr, csr_spmv_dot;
    Kernel matrix_free_apply_dot;  ///< of the consistent or of the printed matrix
    Kernel cg_update, finish_solve, measure_guess, start_from_guess;
    Kernel bound_vertices, chebyshev_step;
    Kernel rest_hinges, bend_hinges, bend_vertices;
    Kernel rest_shapes, order_stretch_limits;
};

/// `options`: resolved. Throws Error(opencl) naming the kernel.
LimiterKernels create_kernels(cl_program program, const Options& options);

}  // namespace apsl::host
