// SPDX-License-Identifier: MIT
#include "kernels/launch.hpp"

#include "host/kernel_arguments.hpp"
#include "host/program.hpp"
#include "support/thorough.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace apsl::test {
namespace {

namespace arguments = host::arguments;

const host::Kernel& kernel(const Arrays& arrays, const Build& build, std::string_view file, const char* name) {
    const auto define = [](const char* macro, std::uint32_t value) {
        return std::string(" -D ") + macro + "=" + std::to_string(value);
    };
    const std::string options =
        "-cl-std=CL1.2" + define("APSLK_WORK_GROUP_SIZE", build.work_group_size) +
        define("APSLK_POSITION_STRIDE", arrays.position_placement.stride) +
        define("APSLK_VELOCITY_STRIDE", arrays.velocity_placement.stride) +
        define("APSLK_MATRIX", static_cast<std::uint32_t>(build.matrix)) +
        define("APSLK_REGULARIZATION_PER_TRIANGLE", build.alpha_per_triangle ? 1 : 0) +
        define("APSLK_CHEBYSHEV", build.chebyshev ? 1 : 0) + define("APSLK_INTEGRATES", build.integrates ? 1 : 0) +
        define("APSLK_KEEPS_CONTACTS", build.keeps_contacts ? 1 : 0) + define("APSLK_BENDS", build.bends ? 1 : 0) +
        define("APSLK_ACCELERATION_PER_VERTEX", build.acceleration_per_vertex ? 1 : 0) +
        define("APSLK_LIMITS_STRETCH", build.limits_stretch ? 1 : 0) +
        define("APSLK_STRETCH_CEILING_PER_TRIANGLE", build.limits_stretch ? 1 : 0);
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
    const host::Kernel& kernel = kernels.at(kernel_key);
    kernel.arguments.assign(kernel.arguments.size(),
                            {});  // these arrays may have the handles of others, released since
    return kernel;
}

// As a caller's buffers; α and accelerations only where there is one for each triangle or vertex.
Buffers caller(const Arrays& a, const Build& build) {
    const auto view = [](const DeviceArray<float>& array, std::uint64_t floats) {
        return BufferView{array.get(), static_cast<std::size_t>(floats) * sizeof(float)};
    };
    return {.positions = view(a.caller_positions, a.position_placement.offset),
            .velocities = view(a.caller_velocities, a.velocity_placement.offset),
            .inverse_masses = view(a.inverse_masses, a.array_offset),
            .rest_areas = view(a.rest_areas, a.array_offset),
            .regularization = build.alpha_per_triangle ? view(a.regularization, a.array_offset) : BufferView{},
            .rest_shapes = view(a.rest_shapes, a.array_offset),
            .stretch_ceilings = view(a.stretch_ceilings, a.array_offset),
            .contacts = view(a.contacts, a.array_offset),
            .rest_hinges = view(a.rest_hinges, a.array_offset),
            .accelerations = build.acceleration_per_vertex ? view(a.caller_accelerations, a.position_placement.offset)
                                                           : BufferView{}};
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
    std::vector<std::uint32_t> sizes;
    for (const std::uint32_t size : {1u, 32u, 64u, 256u})
        if (size <= greatest && (thorough() || size == 1 || size == 64)) sizes.push_back(size);
    return sizes;
}

std::vector<std::uint32_t> awkward_sizes(std::uint32_t work_group_size) {
    const std::set<std::uint32_t> sizes{1, std::max(work_group_size - 1, 1u), work_group_size, work_group_size + 1,
                                        4093};
    return {sizes.begin(), sizes.end()};
}

namespace launch {

void set_parameters(Arrays& a, const Build& build, const apslk_parameter_block& block, std::uint32_t first,
                    std::uint32_t count) {
    const host::Kernel& k = kernel(a, build, "set_parameters.cl", "set_parameters");
    run(arguments::set_parameters(k, a, block, first, count), 1, build, 1);
}

void predict_positions(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "predict_positions.cl", "predict_positions");
    run(arguments::predict_positions(k, a, caller(a, build)), a.groups, build, a.cloth_count());
}

void rest_areas(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "rest_areas.cl", "rest_areas");
    const Buffers buffers = caller(a, build);
    run(arguments::rest_areas(k, a, buffers.positions, buffers.rest_areas), a.groups, build, a.cloth_count());
}

void rest_shapes(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "rest_areas.cl", "rest_shapes");
    const Buffers buffers = caller(a, build);
    run(arguments::rest_shapes(k, a, buffers.positions, buffers.rest_shapes), a.groups, build, a.cloth_count());
}

void rest_hinges(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "rest_hinges.cl", "rest_hinges");
    const Buffers buffers = caller(a, build);
    run(arguments::rest_hinges(k, a, buffers.positions, buffers.rest_hinges), a.groups, build, a.cloth_count());
}

void bend_hinges(Arrays& a, const Build& build, int part) {
    const host::Kernel& k = kernel(a, build, "bend_hinges.cl", "bend_hinges");
    run(arguments::bend_hinges(k, a, caller(a, build), part), a.groups, build, a.cloth_count());
}

void bend_vertices(Arrays& a, const Build& build, int part, int iteration) {
    const host::Kernel& k = kernel(a, build, "bend_hinges.cl", "bend_vertices");
    run(arguments::bend_vertices(k, a, part, iteration), a.groups, build, a.cloth_count());
}

void order_stretch_limits(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "order_triangle_values.cl", "order_stretch_limits");
    run(arguments::order_stretch_limits(k, a, caller(a, build)), a.groups, build, a.cloth_count());
}

void order_triangle_values(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "order_triangle_values.cl", "order_triangle_values");
    run(arguments::order_triangle_values(k, a, caller(a, build)), a.groups, build, a.cloth_count());
}

void assemble_gradients(Arrays& a, const Build& build, int sub_step, bool for_solve) {
    const host::Kernel& k = kernel(a, build, "assemble_gradients.cl", "assemble_gradients");
    run(arguments::assemble_gradients(k, a, build.chebyshev, sub_step, for_solve ? 1 : 0), a.groups, build,
        a.cloth_count());
}

void measure_area_change(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "measure_area_change.cl", "measure_area_change");
    run(arguments::measure_area_change(k, a, a.pressure), a.groups, build, a.cloth_count());
}

void measure_step(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "measure_area_change.cl", "measure_step");
    run(arguments::measure_step(k, a), a.groups, build, a.cloth_count());
}

void judge_whole_step(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "solve_control.cl", "judge_whole_step");
    run(arguments::judge_whole_step(k, a), 1, build, a.cloth_count());
}

void start_small_steps(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "start_small_steps.cl", "start_small_steps");
    run(arguments::start_small_steps(k, a, caller(a, build)), a.groups, build, a.cloth_count());
}

void begin_solve(Arrays& a, const Build& build, int sub_step) {
    const host::Kernel& k = kernel(a, build, "solve_control.cl", "begin_solve");
    run(arguments::begin_solve(k, a, sub_step), 1, build, a.cloth_count());
}

void end_call(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "solve_control.cl", "end_call");
    run(arguments::end_call(k, a), 1, build, a.cloth_count());
}

void assemble_pressure_csr(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "assemble_pressure_csr.cl", "assemble_pressure_csr");
    run(arguments::assemble_pressure_csr(k, a), a.groups, build, a.cloth_count());
}

void csr_spmv_dot(Arrays& a, const Build& build, int iteration) {
    const host::Kernel& k = kernel(a, build, "csr_spmv_dot.cl", "csr_spmv_dot");
    run(arguments::csr_spmv_dot(k, a, a.residual, iteration), a.groups, build, a.cloth_count());
}

void matrix_free_apply_dot(Arrays& a, const Build& build, int iteration) {
    if (build.matrix == Matrix::printed) {
        const host::Kernel& k = kernel(a, build, "matrix_free_printed.cl", "matrix_free_apply_dot");
        run(arguments::matrix_free_printed(k, a, a.residual, iteration), a.groups, build, a.cloth_count());
        return;
    }
    const host::Kernel& k = kernel(a, build, "matrix_free_consistent.cl", "matrix_free_apply_dot");
    run(arguments::matrix_free_consistent(k, a, a.residual, iteration), a.groups, build, a.cloth_count());
}

void measure_guess(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "warm_start.cl", "measure_guess");
    run(arguments::measure_guess(k, a, a.pressure), a.groups, build, a.cloth_count());
}

void start_from_guess(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "warm_start.cl", "start_from_guess");
    run(arguments::start_from_guess(k, a, a.pressure), a.groups, build, a.cloth_count());
}

void cg_update(Arrays& a, const Build& build, int iteration) {
    const host::Kernel& k = kernel(a, build, "cg_update.cl", "cg_update");
    run(arguments::cg_update(k, a, a.pressure, iteration), a.groups, build, a.cloth_count());
}

void bound_vertices(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "bound_matrix.cl", "bound_vertices");
    run(arguments::bound_vertices(k, a), a.groups, build, a.cloth_count());
}

void chebyshev_step(Arrays& a, const Build& build, int sub_step, int launched, int launch) {
    const host::Kernel& k = kernel(a, build, "chebyshev_step.cl", "chebyshev_step");
    run(arguments::chebyshev_step(k, a, a.pressure, sub_step, launched, launch), a.groups, build, a.cloth_count());
}

void finish_solve(Arrays& a, const Build& build, int iterations) {
    const host::Kernel& k = kernel(a, build, "finish_solve.cl", "finish_solve");
    run(arguments::finish_solve(k, a, a.pressure, iterations), 1, build, a.cloth_count());
}

void gather_displacements(Arrays& a, const Build& build, std::uint32_t slot, int sub_step) {
    const host::Kernel& k = kernel(a, build, "gather_displacements.cl", "gather_displacements");
    run(arguments::gather_displacements(k, a, caller(a, build), a.pressure, sub_step, slot), a.groups, build,
        a.cloth_count());
}

void update_velocities(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "update_velocities.cl", "update_velocities");
    run(arguments::update_velocities(k, a, caller(a, build)), a.groups, build, a.cloth_count());
}

void measure_energy(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "measure_energy.cl", "measure_energy");
    run(arguments::measure_energy(k, a, caller(a, build)), a.groups, build, a.cloth_count());
}

void store_step(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "store_step.cl", "store_step");
    run(arguments::store_step(k, a, caller(a, build)), a.groups, build, a.cloth_count());
}

void filter_in_one_group(Arrays& a, const Build& build) {
    const host::Kernel& k = kernel(a, build, "filter_in_one_group.cl", "filter_in_one_group");
    run(arguments::filter_in_one_group(k, a, a.pressure, caller(a, build), a.adjacency.triangle_count), 1, build,
        a.cloth_count());
}

}  // namespace launch
}  // namespace apsl::test
