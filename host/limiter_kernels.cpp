// SPDX-License-Identifier: MIT
#include "limiter_kernels.hpp"

namespace apsl::host {

LimiterKernels create_kernels(cl_program program, const Options& options) {
    LimiterKernels kernels;
    const auto create = [program](Kernel& kernel, const char* name) { kernel = create_kernel(program, name); };
    create(kernels.set_parameters, "set_parameters");
    create(kernels.rest_areas, "rest_areas");
    if (options.execution == Execution::one_group) {
        create(kernels.filter_in_one_group, "filter_in_one_group");
        return kernels;
    }
    if (options.limits_stretch) {
        create(kernels.rest_shapes, "rest_shapes");
        create(kernels.order_stretch_limits, "order_stretch_limits");
    }
    if (options.bends) {
        create(kernels.rest_hinges, "rest_hinges");
        create(kernels.bend_hinges, "bend_hinges");
        create(kernels.bend_vertices, "bend_vertices");
    }
    create(kernels.predict_positions, "predict_positions");
    create(kernels.order_triangle_values, "order_triangle_values");
    create(kernels.measure_step, "measure_step");
    create(kernels.judge_whole_step, "judge_whole_step");
    if (!options.positions_only) create(kernels.start_small_steps, "start_small_steps");
    create(kernels.assemble_gradients, "assemble_gradients");
    create(kernels.begin_solve, "begin_solve");
    create(kernels.gather_displacements, "gather_displacements");
    create(kernels.measure_area_change, "measure_area_change");
    create(kernels.end_call, "end_call");
    if (options.integrates) {
        create(kernels.measure_energy, "measure_energy");
        create(kernels.store_step, "store_step");
    } else {
        create(kernels.update_velocities, "update_velocities");
    }
    if (options.solver == Solver::chebyshev) {
        create(kernels.bound_vertices, "bound_vertices");
        create(kernels.chebyshev_step, "chebyshev_step");
        return kernels;
    }
    create(kernels.cg_update, "cg_update");
    if (options.apply == Apply::assembled_csr) {
        create(kernels.assemble_pressure_csr, "assemble_pressure_csr");
        create(kernels.csr_spmv_dot, "csr_spmv_dot");
    } else {
        create(kernels.matrix_free_apply_dot, "matrix_free_apply_dot");
        if (options.matrix == Matrix::consistent) create(kernels.finish_solve, "finish_solve");
    }
    if (options.warm_start_sub_steps > 0) {
        create(kernels.measure_guess, "measure_guess");
        create(kernels.start_from_guess, "start_from_guess");
    }
    return kernels;
}

}  // namespace apsl::host
