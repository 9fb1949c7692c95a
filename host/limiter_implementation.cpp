// SPDX-License-Identifier: MIT
#include "limiter_implementation.hpp"

#include "caller_objects.hpp"
#include "device_parameters.hpp"
#include "limiter_options.hpp"
#include "opencl_error.hpp"
#include "program.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

namespace apsl {
namespace {

using namespace host;

static_assert(sizeof(Stats) == sizeof(apsl_stats));
static_assert(offsetof(Stats, residual) == offsetof(apsl_stats, residual));
static_assert(offsetof(Stats, status) == offsetof(apsl_stats, status));
static_assert(offsetof(Stats, offender_index) == offsetof(apsl_stats, offender_index));
static_assert(offsetof(Stats, greatest_mass_ratio) == offsetof(apsl_stats, greatest_mass_ratio));
static_assert(std::has_single_bit(sizeof(apsl_parameters)), "clEnqueueFillBuffer takes powers of two");
static_assert(static_cast<int>(Status::not_converged) == APSL_STATUS_NOT_CONVERGED);
static_assert(static_cast<int>(Status::worsened) == APSL_STATUS_WORSENED);
static_assert(static_cast<int>(Status::diverged) == APSL_STATUS_DIVERGED);
static_assert(static_cast<int>(Status::off) == APSL_STATUS_OFF);
static_assert(static_cast<int>(Offender::triangle) == APSL_OFFENDER_TRIANGLE);

// Bytes of a triangle's corner gradients (kernels/gradients.h).
constexpr std::size_t gradient_bytes = 32;

[[noreturn]] void invalid(const std::string& what) {
    throw Error(ErrorCode::invalid_argument, what);
}

/// Floats from the first number of the first vertex to the last of the last.
std::size_t vector_extent(std::size_t vertices, std::uint32_t stride, std::uint32_t component_stride) {
    return (vertices - 1) * stride + std::size_t{2} * component_stride + 1;
}

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
    return build_adjacency(topologies, options.matrix, uses_pattern(options),
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
    create_buffers(adjacency);
    memory.finish_uploads();
    create_kernels();
}

std::size_t StrainLimiter::Implementation::required_scratch_bytes(
    cl_device_id device, std::span<const std::shared_ptr<const Topology>> topologies, const Options& requested) {
    Implementation counted(nullptr, device, device_facts(device), {});
    counted.create_buffers(counted.plan(topologies, requested));
    return counted.memory.required();
}

void StrainLimiter::Implementation::create_program(std::uint32_t max_patch_vertices,
                                                   std::span<const std::byte> binary) {
    patch_vertex_room = room_for_patches(max_patch_vertices);
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

void StrainLimiter::Implementation::create_buffers(const Adjacency& adjacency) {
    cloth_count = static_cast<std::uint32_t>(adjacency.cloths.size());
    vertex_count = adjacency.vertex_count;
    triangle_count = adjacency.triangle_count;
    rest_area_count = adjacency.rest_area_count;
    std::uint32_t largest = 1;
    for (const apsl_cloth& cloth : adjacency.cloths)
        largest = std::max({largest, cloth.triangle_count, cloth.vertex_count});
    groups = group_count(facts, options, largest);

    cloths = upload(adjacency.cloths);
    parameters = buffer(cloth_count * sizeof(apsl_parameters));
    apsl_solve_state initial{};
    initial.adaptive_factor = 1.0f;
    states = upload(std::vector(cloth_count, initial));
    stats = buffer(cloth_count * sizeof(apsl_stats));
    if (!one_group()) partials = buffer(std::size_t{cloth_count} * groups * APSL_PARTIAL_KINDS * sizeof(float));

    vertex_order = upload(adjacency.vertex_order);
    triangle_order = upload(adjacency.triangle_order);
    triangles = upload(adjacency.triangles);
    corner_offsets = upload(adjacency.corner_offsets);
    corners = upload(adjacency.corners);
    if (uses_pattern(options)) {
        row_offsets = upload(adjacency.row_offsets);
        columns = upload(adjacency.columns);
        shared = upload(adjacency.shared);
    } else {
        patches = upload(adjacency.patches);
        patch_vertices = upload(adjacency.patch_vertices);
        local_triangles = upload(adjacency.local_triangles);
    }
    if (assembled()) values = buffer(adjacency.columns.size() * sizeof(float));

    ordered_rest_areas = zeroed_buffer(triangle_count);
    ordered_regularization = upload(std::vector<float>(options.regularization_per_triangle ? triangle_count : 1, 1.0f));
    if (by_chebyshev()) vertex_bounds = buffer(vertex_count * sizeof(float));
    predicted = buffer(std::size_t{vertex_count} * sizeof(cl_float4));
    const std::size_t walking_vertices = options.positions_only ? 1 : vertex_count;
    motion = buffer(walking_vertices * sizeof(cl_float4));
    correction = buffer(walking_vertices * sizeof(cl_float4));
    start_errors = zeroed_buffer(options.positions_only ? 1 : triangle_count);
    gradients = buffer(triangle_count * gradient_bytes);
    residual = zeroed_buffer(triangle_count);
    damped_diagonal = zeroed_buffer(triangle_count);
    direction = buffer(triangle_count * sizeof(float));
    if (!by_chebyshev()) {
        product = zeroed_buffer(triangle_count);
        direction_product = buffer(triangle_count * sizeof(float));
    }
    if (one_group()) {
        pressures.push_back(zeroed_buffer(triangle_count * std::size_t{1 + options.kept_pressures}));
    } else {
        for (std::uint32_t n = 0; n < std::max(options.kept_pressures, 1u); ++n)
            pressures.push_back(zeroed_buffer(triangle_count));
    }
}

void StrainLimiter::Implementation::create_kernels() {
    const auto kernel = [&](const char* name) { return create_kernel(program.get(), name); };
    set_parameters = kernel("set_parameters");
    set_arguments(set_parameters, 0, parameters);
    rest_areas = kernel("rest_areas");
    set_arguments(rest_areas, 0, cloths, vertex_order, triangle_order, triangles);
    if (one_group()) {
        filter_in_one_group = kernel("filter_in_one_group");
        set_arguments(filter_in_one_group, 0, cloths, parameters, states, stats, vertex_order, triangle_order,
                      triangles, patches, patch_vertices, local_triangles, corner_offsets, corners, predicted, motion,
                      correction, gradients, residual, damped_diagonal, product, direction, direction_product,
                      pressures[0], ordered_rest_areas, ordered_regularization, start_errors);
        set_argument(filter_in_one_group, 35, cl_uint{triangle_count});
        return;
    }
    predict_positions = kernel("predict_positions");
    set_arguments(predict_positions, 0, cloths, parameters, states, stats, partials, vertex_order, predicted, motion);
    begin_call = kernel("begin_call");
    set_arguments(begin_call, 0, parameters, states, stats, partials, groups);
    if (!options.positions_only) {
        start_walk = kernel("start_walk");
        set_arguments(start_walk, 0, cloths, parameters, states, vertex_order, predicted, motion, correction);
    }
    order_triangle_values = kernel("order_triangle_values");
    set_arguments(order_triangle_values, 0, cloths, parameters, triangle_order, ordered_rest_areas,
                  ordered_regularization);
    assemble_gradients = kernel("assemble_gradients");
    set_arguments(assemble_gradients, 0, cloths, parameters, states, partials, triangles, predicted, gradients,
                  residual, damped_diagonal, ordered_rest_areas,
                  by_chebyshev() ? vertex_bounds : ordered_regularization, start_errors);
    measure_step = kernel("measure_step");
    set_arguments(measure_step, 0, cloths, parameters, partials, triangles, predicted, motion, ordered_rest_areas,
                  start_errors);
    measure_area_change = kernel("measure_area_change");
    set_arguments(measure_area_change, 0, cloths, parameters, partials, triangles, predicted, motion,
                  ordered_rest_areas);
    begin_solve = kernel("begin_solve");
    set_arguments(begin_solve, 0, parameters, states, stats, partials, groups);
    end_call = kernel("end_call");
    set_arguments(end_call, 0, cloths, states, stats, partials, vertex_order, triangle_order, triangles, predicted,
                  ordered_rest_areas, groups);
    gather_displacements = kernel("gather_displacements");
    set_arguments(gather_displacements, 0, cloths, parameters, states, stats, partials, corner_offsets, corners,
                  gradients);
    set_arguments(gather_displacements, 9, predicted, motion, correction);
    update_velocities = kernel("update_velocities");
    set_arguments(update_velocities, 0, cloths, parameters, states, vertex_order, predicted, correction);
    if (by_chebyshev())
        create_chebyshev();
    else
        create_conjugate_gradient();
}

void StrainLimiter::Implementation::create_chebyshev() {
    const auto kernel = [&](const char* name) { return create_kernel(program.get(), name); };
    bound_vertices = kernel("bound_vertices");
    set_arguments(bound_vertices, 0, cloths, parameters, states, corner_offsets, corners, gradients, predicted, motion,
                  vertex_bounds);
    chebyshev_step = kernel("chebyshev_step");
    set_arguments(chebyshev_step, 0, cloths, parameters, states, patches, patch_vertices, local_triangles,
                  corner_offsets, corners, gradients, residual);
    set_argument(gather_displacements, 8, pressures[0]);
}

void StrainLimiter::Implementation::create_conjugate_gradient() {
    const auto kernel = [&](const char* name) { return create_kernel(program.get(), name); };
    create_apply_kernels();
    cg_update = kernel("cg_update");
    set_arguments(cg_update, 0, cloths, states, partials, residual, damped_diagonal, product, direction,
                  direction_product);
    if (options.kept_pressures == 0) return;
    measure_guess = kernel("measure_guess");
    set_arguments(measure_guess, 0, cloths, states, partials, residual);
    start_from_guess = kernel("start_from_guess");
    set_arguments(start_from_guess, 0, cloths, states, partials, residual, damped_diagonal, product);
}

void StrainLimiter::Implementation::create_apply_kernels() {
    const auto kernel = [&](const char* name) { return create_kernel(program.get(), name); };
    if (assembled()) {
        assemble_pressure_csr = kernel("assemble_pressure_csr");
        set_arguments(assemble_pressure_csr, 0, cloths, states, triangles, predicted, gradients, row_offsets, columns,
                      shared, values);
        apply_dot = kernel("csr_spmv_dot");
        set_arguments(apply_dot, 0, cloths, parameters, states, partials, row_offsets, columns, values, residual,
                      product);
    } else if (options.matrix == Matrix::printed) {
        apply_dot = kernel("matrix_free_apply_dot");
        set_arguments(apply_dot, 0, cloths, parameters, states, partials, triangles, predicted, gradients, row_offsets,
                      columns, shared, residual, product);
    } else {
        apply_dot = kernel("matrix_free_apply_dot");
        set_arguments(apply_dot, 0, cloths, parameters, states, partials, patches, patch_vertices, local_triangles,
                      corner_offsets, corners, gradients, residual, product);
        finish_solve = kernel("finish_solve");
        set_arguments(finish_solve, 0, cloths, parameters, states, partials, patches, patch_vertices, local_triangles,
                      corner_offsets, corners, gradients, residual, damped_diagonal, product, direction,
                      direction_product);
        set_argument(finish_solve, 16, groups);
    }
}

std::size_t StrainLimiter::Implementation::position_floats() const {
    return vector_extent(vertex_count, options.position_stride, options.position_component_stride);
}

void StrainLimiter::Implementation::check_buffers(const Buffers& buffers) const {
    const auto check = [&](const BufferView& view, std::size_t floats, Access access, const char* name) {
        check_view(view, floats, access, context, name);
    };
    check(buffers.positions, position_floats(), options.positions_only ? Access::read_and_write : Access::read,
          "buffers.positions");
    if (!options.positions_only)
        check(buffers.velocities,
              vector_extent(vertex_count, options.velocity_stride, options.velocity_component_stride),
              Access::read_and_write, "buffers.velocities");
    else if (buffers.velocities.buffer)
        invalid("buffers.velocities is given, but Options::positions_only is on");
    check(buffers.inverse_masses, std::size_t{vertex_count - 1} * options.inverse_mass_stride + 1, Access::read,
          "buffers.inverse_masses");
    check(buffers.rest_areas, rest_area_count, Access::read, "buffers.rest_areas");
    if (options.regularization_per_triangle)
        check(buffers.regularization, rest_area_count, Access::read, "buffers.regularization");
    else if (buffers.regularization.buffer)
        invalid("buffers.regularization is given, but Options::regularization_per_triangle is off");
}

void StrainLimiter::Implementation::bind(const Buffers& buffers) const {
    const auto set = [](const Kernel& kernel, cl_uint first, const BufferView& view) {
        set_arguments(kernel, first, view.buffer, cl_ulong{view.offset / sizeof(float)});
    };
    // A kernel needs some buffer there even where it reads none.
    const BufferView& regularization = buffers.regularization.buffer ? buffers.regularization : buffers.rest_areas;
    const BufferView& corrected = options.positions_only ? buffers.positions : buffers.velocities;
    if (one_group()) {
        set(filter_in_one_group, 25, buffers.positions);
        set(filter_in_one_group, 27, corrected);
        set(filter_in_one_group, 29, buffers.inverse_masses);
        set(filter_in_one_group, 31, buffers.rest_areas);
        set(filter_in_one_group, 33, regularization);
        return;
    }
    set(predict_positions, 8, buffers.positions);
    set(predict_positions, 10, corrected);
    set(predict_positions, 12, buffers.inverse_masses);
    if (start_walk.handle) set(start_walk, 7, buffers.velocities);
    set(order_triangle_values, 5, buffers.rest_areas);
    set(order_triangle_values, 7, regularization);
    set(update_velocities, 6, buffers.positions);
    set(update_velocities, 8, corrected);
}

Parameters StrainLimiter::Implementation::as_run(Parameters given) const {
    if (options.positions_only) given.stepping = Stepping::whole_step;
    return given;
}

void StrainLimiter::Implementation::queue_parameters(CommandSequence& commands,
                                                     std::span<const Parameters> given) const {
    // A fill takes its pattern at once and a launch its arguments, so nothing of the caller's has to outlive this call.
    if (given.size() == 1) {
        const apsl_parameters pattern = device_parameters(as_run(given[0]));
        commands.fill(parameters, &pattern, sizeof pattern, 0, cloth_count * sizeof pattern);
        return;
    }
    for (cl_uint first = 0; first < cloth_count; first += APSL_PARAMETER_BLOCK) {
        const cl_uint count = std::min<cl_uint>(cloth_count - first, APSL_PARAMETER_BLOCK);
        apsl_parameter_block block{};
        std::transform(given.begin() + first, given.begin() + first + count, block.entry,
                       [&](const Parameters& p) { return device_parameters(as_run(p)); });
        set_arguments(set_parameters, 1, block, first, count);
        commands.launch(set_parameters, 1, options.work_group_size, 1);
    }
}

void StrainLimiter::Implementation::use_pressures(const BufferHandle& pressure) const {
    set_argument(cg_update, 8, pressure);
    if (finish_solve.handle) set_argument(finish_solve, 15, pressure);
    set_argument(gather_displacements, 8, pressure);
    if (options.kept_pressures == 0) return;
    set_argument(measure_guess, 4, pressure);
    set_argument(start_from_guess, 6, pressure);
}

void StrainLimiter::Implementation::queue_guess(CommandSequence& commands, const BufferHandle& pressure) const {
    const cl_uint multiplied = assembled() ? 7 : 10;
    launch(commands, measure_guess);
    set_argument(apply_dot, multiplied, pressure);
    set_argument(apply_dot, multiplied + 2, cl_int{0});
    launch(commands, apply_dot);
    set_argument(apply_dot, multiplied, residual);
    launch(commands, start_from_guess);
}

void StrainLimiter::Implementation::queue_assembly(CommandSequence& commands, int sub_step) const {
    set_argument(assemble_gradients, 12, cl_int{sub_step});
    launch(commands, assemble_gradients);
    set_argument(begin_solve, 5, cl_int{sub_step});
    launch_one_group(commands, begin_solve);
}

void StrainLimiter::Implementation::queue_displacements(CommandSequence& commands, int sub_step, cl_uint slot) const {
    set_arguments(gather_displacements, 12, cl_int{sub_step}, slot);
    launch(commands, gather_displacements);
}

void StrainLimiter::Implementation::queue_conjugate_gradient(CommandSequence& commands, const CallBudget& budget,
                                                             int sub_step) const {
    const BufferHandle& pressure = pressures[std::min(static_cast<std::size_t>(sub_step), pressures.size() - 1)];
    use_pressures(pressure);
    queue_assembly(commands, sub_step);
    if (assembled()) launch(commands, assemble_pressure_csr);
    if (options.kept_pressures > 0) queue_guess(commands, pressure);
    const cl_int queued =
        finish_solve.handle ? queued_iterations(largest_cloth, budget, sub_step) : budget.max_iterations;
    for (cl_int k = 0; k < queued; ++k) {
        set_argument(apply_dot, assembled() ? 9 : 12, k);
        launch(commands, apply_dot);
        set_argument(cg_update, 9, k);
        launch(commands, cg_update);
    }
    if (queued < budget.max_iterations) {
        set_argument(finish_solve, 17, queued);
        launch_one_group(commands, finish_solve);
    }
    // The slot of the residual after the last iteration.
    queue_displacements(commands, sub_step, static_cast<cl_uint>(queued & 1));
}

void StrainLimiter::Implementation::queue_bound(CommandSequence& commands, int sub_step) const {
    if (sub_step == 0) {
        // Directions are all that bound_vertices reads of the gradients: any scale will do.
        const cl_float one = 1.0f;
        commands.fill(vertex_bounds, &one, sizeof one, 0, vertex_count * sizeof one);
        set_argument(assemble_gradients, 12, cl_int{0});
        launch(commands, assemble_gradients);
    }
    launch(commands, bound_vertices);
}

void StrainLimiter::Implementation::queue_chebyshev(CommandSequence& commands, const CallBudget& budget,
                                                    int sub_step) const {
    if (static_cast<std::uint32_t>(sub_step) % options.bound_period == 0) queue_bound(commands, sub_step);
    queue_assembly(commands, sub_step);
    const cl_int products = queued_products(budget, sub_step);
    for (cl_int k = 0; k < products; ++k) {
        // The last product writes the pressures, those before it take turns.
        const bool to_pressures = (products - 1 - k) % 2 == 0;
        const BufferHandle& next = to_pressures ? pressures[0] : direction;
        const BufferHandle& current = to_pressures ? direction : pressures[0];
        set_arguments(chebyshev_step, 10, current, next, cl_int{sub_step}, products, k);
        launch(commands, chebyshev_step);
    }
    queue_displacements(commands, sub_step, 0);
}

void StrainLimiter::Implementation::queue_many_groups(CommandSequence& commands, const CallBudget& budget) const {
    launch(commands, predict_positions);
    launch(commands, order_triangle_values);
    if (budget.walks) {
        launch(commands, measure_step);
        launch_one_group(commands, begin_call);
        launch(commands, start_walk);
    }
    for (cl_int sub_step = 0; sub_step < budget.sub_steps; ++sub_step) {
        if (by_chebyshev())
            queue_chebyshev(commands, budget, sub_step);
        else
            queue_conjugate_gradient(commands, budget, sub_step);
    }
    launch(commands, measure_area_change);
    launch_one_group(commands, end_call);
    if (budget.sub_steps > 0) launch(commands, update_velocities);
}

cl_event StrainLimiter::Implementation::enqueue(cl_command_queue queue, const Buffers& buffers,
                                                std::span<const Parameters> given,
                                                std::span<const cl_event> wait_list) {
    if (given.size() != 1 && given.size() != cloth_count)
        invalid(std::to_string(given.size()) + " parameters given for " + std::to_string(cloth_count) +
                " cloths, expected one for each or a single one");
    CallBudget budget;
    for (const Parameters& p : given) {
        validate(p);
        if (!p.enabled) continue;
        if (options.positions_only && p.stepping == Stepping::small_steps)
            invalid("stepping is small_steps, which needs velocities: Options::positions_only is on");
        if (by_chebyshev() && p.adaptive_iterations > 0)
            invalid("adaptive_iterations is " + std::to_string(p.adaptive_iterations) +
                    ", expected 0: Options::solver is chebyshev, which has no iterations to go by");
        budget.add(as_run(p));
    }
    check_queue(queue, wait_list, context, device);
    check_buffers(buffers);
    bind(buffers);

    CommandSequence commands(queue, wait_list, profiling ? &profile : nullptr);
    queue_parameters(commands, given);
    if (one_group())
        launch_one_group(commands, filter_in_one_group);
    else
        queue_many_groups(commands, budget);
    return commands.end();
}

cl_event StrainLimiter::Implementation::enqueue_rest_areas(cl_command_queue queue, const BufferView& rest_positions,
                                                           const BufferView& areas,
                                                           std::span<const cl_event> wait_list) {
    check_queue(queue, wait_list, context, device);
    check_view(rest_positions, position_floats(), Access::read, context, "rest_positions");
    check_view(areas, rest_area_count, Access::write, context, "rest_areas");
    set_arguments(rest_areas, 4, rest_positions.buffer, cl_ulong{rest_positions.offset / sizeof(float)}, areas.buffer,
                  cl_ulong{areas.offset / sizeof(float)});
    CommandSequence commands(queue, wait_list, profiling ? &profile : nullptr);
    launch(commands, rest_areas);
    return commands.end();
}

}  // namespace apsl
