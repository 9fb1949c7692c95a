// SPDX-License-Identifier: MIT
#include "kernels/launch.hpp"

#include "host/kernel_launch.hpp"
#include "host/program.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace apsl::test {
namespace {

using host::set_arguments;

const host::Kernel& kernel(const Arrays& arrays, const Build& build, std::string_view file, const char* name) {
    const auto define = [](const char* macro, std::uint32_t value) {
        return std::string(" -D ") + macro + "=" + std::to_string(value);
    };
    const std::string options = "-cl-std=CL1.2" + define("APSL_WORK_GROUP_SIZE", build.work_group_size) +
                                define("APSL_POSITION_STRIDE", arrays.position_placement.stride) +
                                define("APSL_VELOCITY_STRIDE", arrays.velocity_placement.stride) +
                                define("APSL_MATRIX", static_cast<std::uint32_t>(build.matrix)) +
                                define("APSL_REGULARIZATION_PER_TRIANGLE", build.alpha_per_triangle ? 1 : 0) +
                                define("APSL_CHEBYSHEV", build.chebyshev ? 1 : 0);
    // Never released, see transfer_queue() in support/opencl.cpp.
    static auto& programs = *new std::map<std::string, host::ProgramHandle>;
    static auto& kernels = *new std::map<std::string, host::Kernel>;
    const std::string program_key = std::string(file) + options;
    if (!programs.contains(program_key))
        programs[program_key] =
            host::build_program(device().context, device().id, host::program_source({&file, 1}), options);
    const std::string kernel_key = program_key + name;
    if (!kernels.contains(kernel_key))
        kernels.emplace(kernel_key, host::create_kernel(programs[program_key].get(), name));
    return kernels.at(kernel_key);
}

void run(const host::Kernel& kernel, std::uint32_t groups, const Build& build, std::size_t cloths) {
    static const auto& queue = *new Owned<cl_command_queue>(in_order_queue());
    const std::array<std::size_t, 2> global{std::size_t{groups} * build.work_group_size, cloths};
    const std::array<std::size_t, 2> local{build.work_group_size, 1};
    require_success(clEnqueueNDRangeKernel(queue.get(), kernel.handle.get(), 2, nullptr, global.data(), local.data(), 0,
                                           nullptr, nullptr),
                    kernel.name.c_str());
    require_success(clFinish(queue.get()), kernel.name.c_str());
}

}  // namespace

std::vector<std::uint32_t> work_group_sizes() {
    std::size_t greatest = 0;
    require_success(clGetDeviceInfo(device().id, CL_DEVICE_MAX_WORK_GROUP_SIZE, sizeof greatest, &greatest, nullptr),
                    "clGetDeviceInfo");
    std::vector<std::uint32_t> sizes{1, 32, 64, 256};
    std::erase_if(sizes, [&](std::uint32_t size) { return size > greatest; });
    return sizes;
}

std::vector<std::uint32_t> awkward_sizes(std::uint32_t work_group_size) {
    std::vector<std::uint32_t> sizes{1, std::max(work_group_size - 1, 1u), work_group_size, work_group_size + 1, 4093};
    sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
    return sizes;
}

namespace launch {

void set_parameters(Arrays& a, const Build& build, const apsl_parameter_block& block, std::uint32_t first,
                    std::uint32_t count) {
    const host::Kernel& k = kernel(a, build, "set_parameters.cl", "set_parameters");
    set_arguments(k, 0, a.parameters, block, cl_uint{first}, cl_uint{count});
    run(k, 1, build, 1);
}

void predict_positions(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "predict_positions.cl", "predict_positions");
    set_arguments(k, 0, a.cloths, a.parameters, a.states, a.stats, a.partials, a.vertex_order, a.predicted, a.motion,
                  a.caller_positions, cl_ulong{a.position_placement.offset}, a.caller_velocities,
                  cl_ulong{a.velocity_placement.offset}, a.inverse_masses, cl_ulong{a.array_offset});
    run(k, a.groups, build, a.cloth_count());
}

void rest_areas(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "rest_areas.cl", "rest_areas");
    set_arguments(k, 0, a.cloths, a.vertex_order, a.triangle_order, a.triangles, a.caller_positions,
                  cl_ulong{a.position_placement.offset}, a.rest_areas, cl_ulong{a.array_offset});
    run(k, a.groups, build, a.cloth_count());
}

void order_triangle_values(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "order_triangle_values.cl", "order_triangle_values");
    set_arguments(k, 0, a.cloths, a.parameters, a.triangle_order, a.ordered_rest_areas, a.ordered_regularization,
                  a.rest_areas, cl_ulong{a.array_offset}, build.alpha_per_triangle ? a.regularization : a.rest_areas,
                  cl_ulong{a.array_offset});
    run(k, a.groups, build, a.cloth_count());
}

void assemble_gradients(Arrays& a, const Build& build, int sub_step) {
    const host::Kernel& k = kernel(a, build, "assemble_gradients.cl", "assemble_gradients");
    set_arguments(k, 0, a.cloths, a.parameters, a.states, a.partials, a.triangles, a.predicted, a.gradients, a.residual,
                  a.damped_diagonal, a.ordered_rest_areas, build.chebyshev ? a.vertex_bounds : a.ordered_regularization,
                  a.start_errors, cl_int{sub_step});
    run(k, a.groups, build, a.cloth_count());
}

void measure_area_change(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "measure_area_change.cl", "measure_area_change");
    set_arguments(k, 0, a.cloths, a.parameters, a.partials, a.triangles, a.predicted, a.motion, a.ordered_rest_areas);
    run(k, a.groups, build, a.cloth_count());
}

void measure_step(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "measure_area_change.cl", "measure_step");
    set_arguments(k, 0, a.cloths, a.parameters, a.partials, a.triangles, a.predicted, a.motion, a.ordered_rest_areas,
                  a.start_errors);
    run(k, a.groups, build, a.cloth_count());
}

void begin_call(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "solve_control.cl", "begin_call");
    set_arguments(k, 0, a.parameters, a.states, a.stats, a.partials, cl_uint{a.groups});
    run(k, 1, build, a.cloth_count());
}

void start_walk(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "start_walk.cl", "start_walk");
    set_arguments(k, 0, a.cloths, a.parameters, a.states, a.vertex_order, a.predicted, a.motion, a.correction,
                  a.caller_velocities, cl_ulong{a.velocity_placement.offset});
    run(k, a.groups, build, a.cloth_count());
}

void begin_solve(Arrays& a, const Build& build, int sub_step) {
    const host::Kernel& k = kernel(a, build, "solve_control.cl", "begin_solve");
    set_arguments(k, 0, a.parameters, a.states, a.stats, a.partials, cl_uint{a.groups}, cl_int{sub_step});
    run(k, 1, build, a.cloth_count());
}

void end_call(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "solve_control.cl", "end_call");
    set_arguments(k, 0, a.cloths, a.states, a.stats, a.partials, a.vertex_order, a.triangle_order, a.triangles,
                  a.predicted, a.ordered_rest_areas, cl_uint{a.groups});
    run(k, 1, build, a.cloth_count());
}

void assemble_pressure_csr(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "assemble_pressure_csr.cl", "assemble_pressure_csr");
    set_arguments(k, 0, a.cloths, a.states, a.triangles, a.predicted, a.gradients, a.row_offsets, a.columns, a.shared,
                  a.values);
    run(k, a.groups, build, a.cloth_count());
}

void csr_spmv_dot(Arrays& a, const Build& build, int iteration) {
    const host::Kernel& k = kernel(a, build, "csr_spmv_dot.cl", "csr_spmv_dot");
    set_arguments(k, 0, a.cloths, a.parameters, a.states, a.partials, a.row_offsets, a.columns, a.values, a.residual,
                  a.product, cl_int{iteration});
    run(k, a.groups, build, a.cloth_count());
}

void matrix_free_apply_dot(Arrays& a, const Build& build, int iteration) {
    if (build.matrix == Matrix::printed) {
        const host::Kernel& k = kernel(a, build, "matrix_free_printed.cl", "matrix_free_apply_dot");
        set_arguments(k, 0, a.cloths, a.parameters, a.states, a.partials, a.triangles, a.predicted, a.gradients,
                      a.row_offsets, a.columns, a.shared, a.residual, a.product, cl_int{iteration});
        run(k, a.groups, build, a.cloth_count());
        return;
    }
    const host::Kernel& k = kernel(a, build, "matrix_free_consistent.cl", "matrix_free_apply_dot");
    set_arguments(k, 0, a.cloths, a.parameters, a.states, a.partials, a.patches, a.patch_vertices, a.local_triangles,
                  a.corner_offsets, a.corners, a.gradients, a.residual, a.product, cl_int{iteration});
    run(k, a.groups, build, a.cloth_count());
}

void measure_guess(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "first_guess.cl", "measure_guess");
    set_arguments(k, 0, a.cloths, a.states, a.partials, a.residual, a.pressure);
    run(k, a.groups, build, a.cloth_count());
}

void start_from_guess(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "first_guess.cl", "start_from_guess");
    set_arguments(k, 0, a.cloths, a.states, a.partials, a.residual, a.damped_diagonal, a.product, a.pressure);
    run(k, a.groups, build, a.cloth_count());
}

void cg_update(Arrays& a, const Build& build, int iteration) {
    const host::Kernel& k = kernel(a, build, "cg_update.cl", "cg_update");
    set_arguments(k, 0, a.cloths, a.states, a.partials, a.residual, a.damped_diagonal, a.product, a.direction,
                  a.direction_product, a.pressure, cl_int{iteration});
    run(k, a.groups, build, a.cloth_count());
}

void bound_vertices(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "bound_matrix.cl", "bound_vertices");
    set_arguments(k, 0, a.cloths, a.parameters, a.states, a.corner_offsets, a.corners, a.gradients, a.predicted,
                  a.motion, a.vertex_bounds);
    run(k, a.groups, build, a.cloth_count());
}

void chebyshev_step(Arrays& a, const Build& build, int sub_step, int launched, int launch) {
    const host::Kernel& k = kernel(a, build, "chebyshev_step.cl", "chebyshev_step");
    const bool to_pressure = (launched - 1 - launch) % 2 == 0;
    set_arguments(k, 0, a.cloths, a.parameters, a.states, a.patches, a.patch_vertices, a.local_triangles,
                  a.corner_offsets, a.corners, a.gradients, a.residual, to_pressure ? a.direction : a.pressure,
                  to_pressure ? a.pressure : a.direction, cl_int{sub_step}, cl_int{launched}, cl_int{launch});
    run(k, a.groups, build, a.cloth_count());
}

void finish_solve(Arrays& a, const Build& build, int iterations) {
    const host::Kernel& k = kernel(a, build, "finish_solve.cl", "finish_solve");
    set_arguments(k, 0, a.cloths, a.parameters, a.states, a.partials, a.patches, a.patch_vertices, a.local_triangles,
                  a.corner_offsets, a.corners, a.gradients, a.residual, a.damped_diagonal, a.product, a.direction,
                  a.direction_product, a.pressure, cl_uint{a.groups}, cl_int{iterations});
    run(k, 1, build, a.cloth_count());
}

void gather_displacements(Arrays& a, const Build& build, std::uint32_t slot, int sub_step) {
    const host::Kernel& k = kernel(a, build, "gather_displacements.cl", "gather_displacements");
    set_arguments(k, 0, a.cloths, a.parameters, a.states, a.stats, a.partials, a.corner_offsets, a.corners, a.gradients,
                  a.pressure, a.predicted, a.motion, a.correction, cl_int{sub_step}, cl_uint{slot});
    run(k, a.groups, build, a.cloth_count());
}

void update_velocities(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "update_velocities.cl", "update_velocities");
    set_arguments(k, 0, a.cloths, a.parameters, a.states, a.vertex_order, a.predicted, a.correction, a.caller_positions,
                  cl_ulong{a.position_placement.offset}, a.caller_velocities, cl_ulong{a.velocity_placement.offset});
    run(k, a.groups, build, a.cloth_count());
}

void filter_in_one_group(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "filter_in_one_group.cl", "filter_in_one_group");
    set_arguments(k, 0, a.cloths, a.parameters, a.states, a.stats, a.vertex_order, a.triangle_order, a.triangles,
                  a.patches, a.patch_vertices, a.local_triangles, a.corner_offsets, a.corners, a.predicted, a.motion,
                  a.correction, a.gradients, a.residual, a.damped_diagonal, a.product, a.direction, a.direction_product,
                  a.pressure, a.ordered_rest_areas, a.ordered_regularization, a.start_errors, a.caller_positions,
                  cl_ulong{a.position_placement.offset}, a.caller_velocities, cl_ulong{a.velocity_placement.offset},
                  a.inverse_masses, cl_ulong{a.array_offset}, a.rest_areas, cl_ulong{a.array_offset},
                  build.alpha_per_triangle ? a.regularization : a.rest_areas, cl_ulong{a.array_offset},
                  cl_uint{a.adjacency.triangle_count});
    run(k, 1, build, a.cloth_count());
}

}  // namespace launch
}  // namespace apsl::test
