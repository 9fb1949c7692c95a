// SPDX-License-Identifier: MIT
#include "limiter_options.hpp"

#include "invalid.hpp"

#include <apsl/error.hpp>

#include <algorithm>
#include <bit>

namespace apsl::host {
namespace {

// Largest cloth for which one work-group is faster than separate launches. Measured on a CPU of two units: faster at
// 2,048 triangles, within 15 % at 8,192 (with one core in place of two), slower at 32,768. More compute units favour
// separate launches.
std::size_t one_group_triangles(const DeviceFacts& facts) {
    constexpr std::size_t least = 6144;
    return facts.is_cpu && facts.compute_units > 1 ? least * facts.compute_units / (facts.compute_units - 1) : least;
}

// Vertices side by side, or components in runs: otherwise two numbers share a place.
void check_vector_strides(std::uint32_t stride, std::uint32_t component_stride, std::size_t vertices,
                          const std::string& name) {
    if (component_stride == 0) invalid(name + "_component_stride is 0, expected at least 1");
    if (stride > std::size_t{2} * component_stride) return;
    if (component_stride == 1) invalid(name + "_stride is " + std::to_string(stride) + ", expected at least 3");
    if (stride == 0) invalid(name + "_stride is 0, expected at least 1");
    const std::size_t run = (vertices - 1) * stride + 1;
    if (component_stride < run)
        invalid(name + "_component_stride is " + std::to_string(component_stride) + ", expected at least " +
                std::to_string(run) + " for " + std::to_string(vertices) + " vertices with " + name + "_stride " +
                std::to_string(stride));
}

std::size_t total_vertices(std::span<const std::shared_ptr<const Topology>> cloths) {
    std::size_t total = 0;
    for (const auto& topology : cloths) total += topology->vertex_count();
    return total;
}

bool matrix_free_consistent(const Options& options) {
    return options.matrix == Matrix::consistent && options.apply == Apply::matrix_free;
}

// With warm starts or with α per triangle as well a GPU's kernel needs more registers than there are.
bool one_group_fits(const Options& options, const DeviceFacts& facts) {
    return facts.is_cpu || (options.warm_start_sub_steps == 0 && !options.regularization_per_triangle);
}

Execution resolve_execution(const Options& options, const DeviceFacts& facts, std::size_t largest) {
    switch (options.execution) {
        case Execution::automatic:
            return matrix_free_consistent(options) && options.solver == Solver::conjugate_gradient &&
                           !options.integrates && !options.keeps_contacts && one_group_fits(options, facts) &&
                           largest <= one_group_triangles(facts)
                       ? Execution::one_group
                       : Execution::many_groups;
        case Execution::many_groups:
            return options.execution;
        case Execution::one_group:
            if (!one_group_fits(options, facts))
                throw Error(ErrorCode::unsupported,
                            "execution is one_group, which takes warm_start_sub_steps and regularization_per_triangle "
                            "on a CPU only");
            return options.execution;
    }
    return options.execution;
}

}  // namespace

std::size_t largest_triangle_count(std::span<const std::shared_ptr<const Topology>> cloths) {
    std::size_t largest = 0;
    for (const auto& topology : cloths) largest = std::max(largest, topology->triangle_count());
    return largest;
}

Options resolve(Options options, const DeviceFacts& facts, std::span<const std::shared_ptr<const Topology>> cloths) {
    validate(options);
    options.solver = resolved_solver(options);
    const std::size_t vertices = total_vertices(cloths);
    check_vector_strides(options.position_stride, options.position_component_stride, vertices, "position");
    check_vector_strides(options.velocity_stride, options.velocity_component_stride, vertices, "velocity");
    if (options.inverse_mass_stride == 0) invalid("inverse_mass_stride is 0, expected at least 1");
    options.execution = resolve_execution(options, facts, largest_triangle_count(cloths));
    if (options.work_group_size == 0)
        options.work_group_size =
            facts.is_cpu
                ? 1
                : static_cast<std::uint32_t>(std::bit_floor(std::min<std::size_t>(facts.max_work_group_size, 256)));
    if (options.work_group_size > facts.max_work_group_size)
        throw Error(ErrorCode::unsupported, "work_group_size is " + std::to_string(options.work_group_size) +
                                                ", device " + facts.name + " allows " +
                                                std::to_string(facts.max_work_group_size));
    return options;
}

bool uses_pattern(const Options& options) {
    return !matrix_free_consistent(options);
}

std::vector<std::string_view> kernel_files(const Options& options) {
    if (options.execution == Execution::one_group)
        return {"set_parameters.cl", "rest_areas.cl", "filter_in_one_group.cl"};
    std::vector<std::string_view> files{"set_parameters.cl",       "predict_positions.cl",   "order_triangle_values.cl",
                                        "assemble_gradients.cl",   "measure_area_change.cl", "solve_control.cl",
                                        "gather_displacements.cl", "rest_areas.cl"};
    if (options.integrates)
        files.insert(files.end(), {"measure_energy.cl", "store_step.cl"});
    else
        files.push_back("update_velocities.cl");
    if (options.bends) files.insert(files.end(), {"rest_hinges.cl", "bend_hinges.cl"});
    if (!options.positions_only) files.push_back("start_small_steps.cl");
    if (options.solver == Solver::chebyshev) {
        files.insert(files.end(), {"bound_matrix.cl", "chebyshev_step.cl"});
        return files;
    }
    files.push_back("cg_update.cl");
    if (options.warm_start_sub_steps > 0) files.push_back("warm_start.cl");
    if (options.apply == Apply::assembled_csr)
        files.insert(files.end(), {"assemble_pressure_csr.cl", "csr_spmv_dot.cl"});
    else if (options.matrix == Matrix::printed)
        files.push_back("matrix_free_printed.cl");
    else
        files.insert(files.end(), {"matrix_free_consistent.cl", "finish_solve.cl"});
    return files;
}

std::uint32_t room_for_patches(const DeviceFacts& facts, std::uint32_t largest) {
    constexpr std::uint32_t step = 64;  // 1 KiB of local memory
    const std::uint32_t least = facts.is_cpu ? 1024 : step;
    return std::max((largest + step - 1) / step * step, least);
}

std::string build_options(const Options& options, std::uint32_t patch_vertices) {
    const auto define = [](const char* name, std::uint32_t value) {
        return std::string(" -D ") + name + "=" + std::to_string(value);
    };
    return "-cl-std=CL1.2" + define("APSLK_WORK_GROUP_SIZE", options.work_group_size) +
           define("APSLK_POSITION_STRIDE", options.position_stride) +
           define("APSLK_VELOCITY_STRIDE", options.velocity_stride) +
           define("APSLK_POSITION_COMPONENT_STRIDE", options.position_component_stride) +
           define("APSLK_VELOCITY_COMPONENT_STRIDE", options.velocity_component_stride) +
           define("APSLK_INVERSE_MASS_STRIDE", options.inverse_mass_stride) +
           define("APSLK_POSITIONS_ONLY", options.positions_only ? 1 : 0) +
           define("APSLK_INTEGRATES", options.integrates ? 1 : 0) +
           define("APSLK_ACCELERATION_PER_VERTEX", options.acceleration_per_vertex ? 1 : 0) +
           define("APSLK_KEEPS_CONTACTS", options.keeps_contacts ? 1 : 0) +
           define("APSLK_BENDS", options.bends ? 1 : 0) + define("APSLK_TETHERS", options.tethers_per_vertex) +
           define("APSLK_MATRIX", static_cast<std::uint32_t>(options.matrix)) +
           define("APSLK_PATCH_VERTICES", patch_vertices) +
           define("APSLK_REGULARIZATION_PER_TRIANGLE", options.regularization_per_triangle ? 1 : 0) +
           define("APSLK_WARM_START_SUB_STEPS", options.warm_start_sub_steps) +
           define("APSLK_CHEBYSHEV", options.solver == Solver::chebyshev ? 1 : 0) +
           define("APSLK_LIMITS_STRETCH", options.limits_stretch ? 1 : 0) +
           define("APSLK_STRETCH_CEILING_PER_TRIANGLE", options.stretch_ceiling_per_triangle ? 1 : 0);
}

std::uint32_t patch_triangles(const DeviceFacts& facts, const Options& options, std::size_t largest) {
    const std::size_t most = facts.is_cpu ? 1024 : 2 * std::size_t{options.work_group_size};
    if (options.execution == Execution::one_group) return static_cast<std::uint32_t>(most);
    const std::size_t share = largest / (std::size_t{facts.compute_units} * 4);
    return static_cast<std::uint32_t>(std::clamp(share, std::min<std::size_t>(128, most), most));
}

std::uint32_t group_count(const DeviceFacts& facts, const Options& options, std::uint32_t largest) {
    if (options.execution == Execution::one_group) return 1;
    // A group that has less to do than this costs more to start than it saves.
    const std::uint32_t least_share = std::max(options.work_group_size, 256u);
    return std::clamp((largest + least_share - 1) / least_share, 1u, facts.compute_units * 8);
}

}  // namespace apsl::host
