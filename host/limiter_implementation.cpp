// SPDX-License-Identifier: MIT
#include "limiter_implementation.hpp"

#include "caller_objects.hpp"
#include "device_parameters.hpp"
#include "invalid.hpp"
#include "kernel_arguments.hpp"
#include "limiter_options.hpp"
#include "opencl_error.hpp"
#include "program.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

namespace apsl {
namespace {

using namespace host;

static_assert(sizeof(Stats) == sizeof(apslk_stats));
static_assert(offsetof(Stats, residual) == offsetof(apslk_stats, residual));
static_assert(offsetof(Stats, status) == offsetof(apslk_stats, status));
static_assert(offsetof(Stats, offender_index) == offsetof(apslk_stats, offender_index));
static_assert(offsetof(Stats, greatest_mass_ratio) == offsetof(apslk_stats, greatest_mass_ratio));
static_assert(offsetof(Stats, stretch_rows) == offsetof(apslk_stats, stretch_rows));
static_assert(offsetof(Stats, energy_kept) == offsetof(apslk_stats, energy_kept));
static_assert(std::has_single_bit(sizeof(apslk_parameters)), "clEnqueueFillBuffer takes powers of two");
static_assert(static_cast<int>(Status::not_converged) == APSLK_STATUS_NOT_CONVERGED);
static_assert(static_cast<int>(Status::worsened) == APSLK_STATUS_WORSENED);
static_assert(static_cast<int>(Status::diverged) == APSLK_STATUS_DIVERGED);
static_assert(static_cast<int>(Status::off) == APSLK_STATUS_OFF);
static_assert(static_cast<int>(Offender::triangle) == APSLK_OFFENDER_TRIANGLE);

void check_topologies(std::span<const std::shared_ptr<const Topology>> cloths) {
    if (cloths.empty()) invalid("no cloths given, expected at least one");
    for (const auto& topology : cloths)
        if (!topology) invalid("a cloth's topology is null");
}

}  // namespace

StrainLimiter::Implementation::Implementation(cl_context the_context, cl_device_id the_device,
                                              const DeviceFacts& the_facts, const BufferView& scratch)
    : facts(the_facts), context(the_context), device(the_device), memory(context, device, facts, scratch) {
}

Adjacency StrainLimiter::Implementation::plan(std::span<const std::shared_ptr<const Topology>> topologies,
                                              const Options& requested) {
    check_topologies(topologies);
    options = resolve(requested, facts, topologies);
    largest_cloth = largest_triangle_count(topologies);
    return build_adjacency(topologies, options.matrix, uses_pattern(options), options.bends,
                           patch_triangles(facts, options, largest_cloth));
}

StrainLimiter::Implementation::Implementation(cl_context the_context, cl_device_id the_device,
                                              std::span<const std::shared_ptr<const Topology>> topologies,
                                              const Options& requested, std::span<const std::byte> program_binary,
                                              const BufferView& scratch, const Implementation* built)
    : Implementation(the_context, the_device, built ? built->facts : device_facts(the_device), scratch) {
    if (built) memory.keep_clear_of(built->memory);
    const Adjacency adjacency = plan(topologies, requested);
    if (built && adjacency.max_patch_vertices <= built->patch_vertex_room)
        share_program(*built);
    else
        create_program(adjacency.max_patch_vertices, program_binary);
    create_arrays(adjacency);
    memory.finish_uploads();
    kernels = create_kernels(program.get(), options);
    resolved.reserve(cloth_count);
}

std::size_t StrainLimiter::Implementation::required_scratch_bytes(
    cl_device_id device, std::span<const std::shared_ptr<const Topology>> topologies, const Options& requested) {
    Implementation counted(nullptr, device, device_facts(device), {});
    counted.create_arrays(counted.plan(topologies, requested));
    return counted.memory.required();
}

void StrainLimiter::Implementation::create_program(std::uint32_t max_patch_vertices,
                                                   std::span<const std::byte> binary) {
    patch_vertex_room = room_for_patches(facts, max_patch_vertices);
    const std::string source = program_source(kernel_files(options));
    const std::string flags = build_options(options, patch_vertex_room);
    program_fingerprint = host::program_fingerprint(device, source, flags);
    const UnpackedBinary unpacked = unpack_binary(binary, program_fingerprint);
    binary_use = unpacked.use;
    if (binary_use == ProgramBinaryUse::taken) {
        program = load_program(context, device, unpacked.driver_binary, flags);
        if (program) return;
        binary_use = ProgramBinaryUse::refused_by_driver;
    }
    program = build_program(context, device, source, flags);
}

void StrainLimiter::Implementation::share_program(const Implementation& built) {
    check(clRetainProgram(built.program.get()), "keeping the kernel program");
    program = ProgramHandle(built.program.get());
    program_fingerprint = built.program_fingerprint;
    binary_use = built.binary_use;
    patch_vertex_room = built.patch_vertex_room;
}

std::vector<std::byte> StrainLimiter::Implementation::program_binary() const {
    const std::vector<std::byte> binary = driver_binary(program.get(), device);
    return binary.empty() ? binary : pack_binary(program_fingerprint, binary);
}

void StrainLimiter::Implementation::create_arrays(const Adjacency& adjacency) {
    cloth_count = static_cast<std::uint32_t>(adjacency.cloths.size());
    vertex_count = adjacency.vertex_count;
    triangle_count = adjacency.triangle_count;
    caller_counts = {adjacency.vertex_count, adjacency.rest_area_count, adjacency.hinges.size()};
    std::uint32_t largest = 1;
    for (const apslk_cloth& cloth : adjacency.cloths)
        largest = std::max({largest, cloth.triangle_count, cloth.vertex_count});
    arrays = make_device_arrays(memory, adjacency, options, group_count(facts, options, largest));
}

void StrainLimiter::Implementation::queue_parameters(CommandSequence& commands,
                                                     std::span<const ResolvedParameters> given) const {
    // A fill takes its pattern at once and a launch its arguments, so nothing of the caller's has to outlive this call.
    if (given.size() == 1) {
        const apslk_parameters pattern = device_parameters(given[0]);
        commands.fill(arrays.parameters, &pattern, sizeof pattern, 0, cloth_count * sizeof pattern);
        return;
    }
    for (cl_uint first = 0; first < cloth_count; first += APSLK_PARAMETER_BLOCK) {
        const cl_uint count = std::min<cl_uint>(cloth_count - first, APSLK_PARAMETER_BLOCK);
        apslk_parameter_block block{};
        std::transform(given.begin() + first, given.begin() + first + count, block.entry, device_parameters);
        commands.launch(arguments::set_parameters(kernels.set_parameters, arrays, block, first, count), 1,
                        options.work_group_size, 1);
    }
}

int StrainLimiter::Implementation::solve_iterations(const CallBudget& budget, int sub_step) const {
    if (by_chebyshev()) return queued_products(budget, sub_step, options.limits_stretch);
    return kernels.finish_solve.handle ? queued_iterations(largest_cloth, budget, sub_step) : budget.max_iterations;
}

void StrainLimiter::Implementation::check_launches(const CallBudget& budget) const {
    // An iteration of CG is two.
    const std::int64_t an_iteration = by_chebyshev() ? 1 : 2;
    const std::int64_t bending = caller_counts.hinges > 0 ? budget.bending_iterations : 0;
    if (budget.sub_steps * (an_iteration * budget.max_iterations + bending) <= most_launches) return;
    std::int64_t launches = budget.sub_steps * bending;
    for (int sub_step = 0; sub_step < budget.sub_steps; ++sub_step)
        launches += an_iteration * solve_iterations(budget, sub_step);
    if (launches > most_launches)
        invalid("the call would queue " + std::to_string(launches) + " launches for solves and bending in " +
                std::to_string(budget.sub_steps) + " sub-steps, expected at most " + std::to_string(most_launches) +
                "; lower sub_steps, max_iterations or bending_iterations, or raise regularization or tolerance");
}

void StrainLimiter::Implementation::queue_product(CommandSequence& commands, const BufferHandle& multiplied,
                                                  cl_int iteration) const {
    if (assembled())
        launch(commands, arguments::csr_spmv_dot(kernels.csr_spmv_dot, arrays, multiplied, iteration));
    else if (options.matrix == Matrix::printed)
        launch(commands, arguments::matrix_free_printed(kernels.matrix_free_apply_dot, arrays, multiplied, iteration));
    else
        launch(commands,
               arguments::matrix_free_consistent(kernels.matrix_free_apply_dot, arrays, multiplied, iteration));
}

void StrainLimiter::Implementation::queue_guess(CommandSequence& commands, const BufferHandle& pressure) const {
    launch(commands, arguments::measure_guess(kernels.measure_guess, arrays, pressure));
    queue_product(commands, pressure, 0);
    launch(commands, arguments::start_from_guess(kernels.start_from_guess, arrays, pressure));
}

void StrainLimiter::Implementation::queue_assembly(CommandSequence& commands, cl_int sub_step) const {
    launch(commands, arguments::assemble_gradients(kernels.assemble_gradients, arrays, by_chebyshev(), sub_step, 1));
    launch_one_group(commands, arguments::begin_solve(kernels.begin_solve, arrays, sub_step));
}

void StrainLimiter::Implementation::queue_conjugate_gradient(CommandSequence& commands, const Buffers& buffers,
                                                             const CallBudget& budget, cl_int sub_step) const {
    const BufferHandle& pressure =
        arrays.pressures[std::min(static_cast<std::size_t>(sub_step), arrays.pressures.size() - 1)];
    queue_assembly(commands, sub_step);
    if (assembled()) launch(commands, arguments::assemble_pressure_csr(kernels.assemble_pressure_csr, arrays));
    if (options.warm_start_sub_steps > 0) queue_guess(commands, pressure);
    const cl_int queued = solve_iterations(budget, sub_step);
    for (cl_int k = 0; k < queued; ++k) {
        queue_product(commands, arrays.residual, k);
        launch(commands, arguments::cg_update(kernels.cg_update, arrays, pressure, k));
    }
    if (queued < budget.max_iterations)
        launch_one_group(commands, arguments::finish_solve(kernels.finish_solve, arrays, pressure, queued));
    // The slot of the residual after the last iteration.
    const auto slot = static_cast<cl_uint>(queued & 1);
    launch(commands,
           arguments::gather_displacements(kernels.gather_displacements, arrays, buffers, pressure, sub_step, slot));
}

void StrainLimiter::Implementation::queue_bound(CommandSequence& commands, cl_int sub_step) const {
    if (sub_step == 0) {
        // Directions are all that bound_vertices reads of the gradients: any scale will do.
        const cl_float one = 1.0f;
        commands.fill(arrays.vertex_bounds, &one, sizeof one, 0, vertex_count * sizeof one);
    }
    // The gradients of a sub-step before bound nothing: a sliver turns in between, and a polynomial grows without limit
    // beyond its bound.
    launch(commands, arguments::assemble_gradients(kernels.assemble_gradients, arrays, by_chebyshev(), sub_step, 0));
    launch(commands, arguments::bound_vertices(kernels.bound_vertices, arrays));
}

void StrainLimiter::Implementation::queue_chebyshev(CommandSequence& commands, const Buffers& buffers,
                                                    const CallBudget& budget, cl_int sub_step) const {
    const BufferHandle& pressure = arrays.pressures[0];
    if (static_cast<std::uint32_t>(sub_step) % options.bound_interval == 0) queue_bound(commands, sub_step);
    queue_assembly(commands, sub_step);
    const cl_int products = solve_iterations(budget, sub_step);
    for (cl_int k = 0; k < products; ++k)
        launch(commands, arguments::chebyshev_step(kernels.chebyshev_step, arrays, pressure, sub_step, products, k));
    launch(commands,
           arguments::gather_displacements(kernels.gather_displacements, arrays, buffers, pressure, sub_step, 0));
}

void StrainLimiter::Implementation::queue_bending(CommandSequence& commands, const Buffers& buffers,
                                                  const CallBudget& budget, cl_int part) const {
    if (budget.bending_iterations == 0 || caller_counts.hinges == 0) return;
    launch(commands, arguments::bend_hinges(kernels.bend_hinges, arrays, buffers, part));
    for (cl_int iteration = 0; iteration < budget.bending_iterations; ++iteration)
        launch(commands, arguments::bend_vertices(kernels.bend_vertices, arrays, part, iteration));
}

void StrainLimiter::Implementation::queue_many_groups(CommandSequence& commands, const Buffers& buffers,
                                                      const CallBudget& budget) const {
    launch(commands, arguments::predict_positions(kernels.predict_positions, arrays, buffers));
    launch(commands, arguments::order_triangle_values(kernels.order_triangle_values, arrays, buffers));
    if (options.limits_stretch)
        launch(commands, arguments::order_stretch_limits(kernels.order_stretch_limits, arrays, buffers));
    if (budget.takes_small_steps) {
        launch(commands, arguments::measure_step(kernels.measure_step, arrays));
        launch_one_group(commands, arguments::judge_whole_step(kernels.judge_whole_step, arrays));
        launch(commands, arguments::start_small_steps(kernels.start_small_steps, arrays, buffers));
        queue_bending(commands, buffers, budget, 0);
    }
    for (cl_int sub_step = 0; sub_step < budget.sub_steps; ++sub_step) {
        if (by_chebyshev())
            queue_chebyshev(commands, buffers, budget, sub_step);
        else
            queue_conjugate_gradient(commands, buffers, budget, sub_step);
        // The last sub-step starts no part.
        if (sub_step + 2 < budget.sub_steps) queue_bending(commands, buffers, budget, sub_step + 1);
    }
    launch(commands, arguments::measure_area_change(kernels.measure_area_change, arrays, arrays.pressures.front()));
    if (options.integrates) launch(commands, arguments::measure_energy(kernels.measure_energy, arrays, buffers));
    launch_one_group(commands, arguments::end_call(kernels.end_call, arrays));
    if (options.integrates)
        launch(commands, arguments::store_step(kernels.store_step, arrays, buffers));
    else if (budget.sub_steps > 0)
        launch(commands, arguments::update_velocities(kernels.update_velocities, arrays, buffers));
}

cl_event StrainLimiter::Implementation::enqueue(cl_command_queue queue, const Buffers& buffers,
                                                std::span<const Parameters> given,
                                                std::span<const cl_event> wait_list) {
    check_parameter_count(given.size(), cloth_count);
    CallBudget budget;
    resolved.clear();
    for (const Parameters& p : given) {
        if (p.enabled)
            validate(options, p);
        else
            validate(p);
        resolved.emplace_back(p, options);
        if (p.enabled) budget.add(resolved.back());
    }
    if (!one_group()) check_launches(budget);
    check_queue(queue, wait_list, context, device);
    check_buffers(buffers, options, caller_counts, context, memory.scratch_in_use());

    CommandSequence commands(queue, wait_list, profiling ? &profile : nullptr);
    queue_parameters(commands, resolved);
    if (one_group())
        launch_one_group(commands, arguments::filter_in_one_group(kernels.filter_in_one_group, arrays,
                                                                  arrays.pressures[0], buffers, triangle_count));
    else
        queue_many_groups(commands, buffers, budget);
    return commands.end();
}

template <class SetArguments>
cl_event StrainLimiter::Implementation::enqueue_rest(cl_command_queue queue, const BufferView& rest_positions,
                                                     const BufferView& target, std::size_t floats, const char* name,
                                                     std::span<const cl_event> wait_list,
                                                     const SetArguments& set_arguments) {
    check_queue(queue, wait_list, context, device);
    check_rest_buffers(rest_positions, {name, target, true, floats}, options, caller_counts, context,
                       memory.scratch_in_use());
    CommandSequence commands(queue, wait_list, profiling ? &profile : nullptr);
    launch(commands, set_arguments());
    return commands.end();
}

cl_event StrainLimiter::Implementation::enqueue_rest_areas(cl_command_queue queue, const BufferView& rest_positions,
                                                           const BufferView& areas,
                                                           std::span<const cl_event> wait_list) {
    return enqueue_rest(queue, rest_positions, areas, caller_counts.triangles, "rest_areas", wait_list, [&]() -> auto& {
        return arguments::rest_areas(kernels.rest_areas, arrays, rest_positions, areas);
    });
}

cl_event StrainLimiter::Implementation::enqueue_rest_shapes(cl_command_queue queue, const BufferView& rest_positions,
                                                            const BufferView& shapes,
                                                            std::span<const cl_event> wait_list) {
    if (!options.limits_stretch) invalid("rest shapes are asked for, but Options::limits_stretch is off");
    return enqueue_rest(
        queue, rest_positions, shapes, 4 * caller_counts.triangles, "rest_shapes", wait_list,
        [&]() -> auto& { return arguments::rest_shapes(kernels.rest_shapes, arrays, rest_positions, shapes); });
}

cl_event StrainLimiter::Implementation::enqueue_rest_hinges(cl_command_queue queue, const BufferView& rest_positions,
                                                            const BufferView& hinges,
                                                            std::span<const cl_event> wait_list) {
    if (!options.bends) invalid("rest hinges are asked for, but Options::bends is off");
    if (caller_counts.hinges == 0) {
        check_queue(queue, wait_list, context, device);
        return CommandSequence(queue, wait_list, nullptr).end();
    }
    return enqueue_rest(
        queue, rest_positions, hinges, 2 * caller_counts.hinges, "rest_hinges", wait_list,
        [&]() -> auto& { return arguments::rest_hinges(kernels.rest_hinges, arrays, rest_positions, hinges); });
}

}  // namespace apsl
