// SPDX-License-Identifier: MIT
#include "device_facts.hpp"
#include "handles.hpp"
#include "kernel_launch.hpp"
#include "limiter_plan.hpp"
#include "opencl_error.hpp"
#include "program.hpp"

#include <apsl/strain_limiter.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>

namespace apsl {
namespace {

using namespace host;

static_assert(sizeof(Stats) == sizeof(apsl_stats));
static_assert(offsetof(Stats, residual) == offsetof(apsl_stats, residual));
static_assert(offsetof(Stats, status) == offsetof(apsl_stats, status));
static_assert(std::has_single_bit(sizeof(apsl_parameters)), "clEnqueueFillBuffer takes powers of two");
static_assert(static_cast<int>(Status::not_converged) == APSL_STATUS_NOT_CONVERGED);
static_assert(static_cast<int>(Status::diverged) == APSL_STATUS_DIVERGED);

[[noreturn]] void invalid(const std::string& what) {
    throw Error(ErrorCode::invalid_argument, what);
}

Options resolve(Options options, const DeviceFacts& facts) {
    if (options.position_stride < 3)
        invalid("position_stride is " + std::to_string(options.position_stride) + ", expected at least 3");
    if (options.velocity_stride < 3)
        invalid("velocity_stride is " + std::to_string(options.velocity_stride) + ", expected at least 3");
    if (options.matrix != Matrix::consistent && options.matrix != Matrix::printed) invalid("unknown matrix");
    if (options.apply != Apply::assembled_csr && options.apply != Apply::matrix_free) invalid("unknown apply");
    if (options.work_group_size == 0)
        options.work_group_size =
            facts.is_cpu
                ? 1
                : static_cast<std::uint32_t>(std::bit_floor(std::min<std::size_t>(facts.max_work_group_size, 256)));
    if (!std::has_single_bit(options.work_group_size))
        invalid("work_group_size is " + std::to_string(options.work_group_size) + ", expected a power of two");
    if (options.work_group_size > facts.max_work_group_size)
        throw Error(ErrorCode::unsupported, "work_group_size is " + std::to_string(options.work_group_size) +
                                                ", device " + facts.name + " allows " +
                                                std::to_string(facts.max_work_group_size));
    return options;
}

std::vector<std::string_view> kernel_files(const Options& options) {
    std::vector<std::string_view> files{"predict_positions.cl", "assemble_gradients.cl",   "solve_control.cl",
                                        "cg_update.cl",         "gather_displacements.cl", "update_velocities.cl"};
    if (options.apply == Apply::assembled_csr) {
        files.push_back("assemble_pressure_csr.cl");
        files.push_back("csr_spmv_dot.cl");
    } else {
        files.push_back(options.matrix == Matrix::consistent ? "matrix_free_consistent.cl" : "matrix_free_printed.cl");
    }
    return files;
}

std::string build_options(const Options& options) {
    const auto define = [](const char* name, std::uint32_t value) {
        return std::string(" -D ") + name + "=" + std::to_string(value);
    };
    return "-cl-std=CL1.2" + define("APSL_WORK_GROUP_SIZE", options.work_group_size) +
           define("APSL_POSITION_STRIDE", options.position_stride) +
           define("APSL_VELOCITY_STRIDE", options.velocity_stride) +
           define("APSL_MATRIX", static_cast<std::uint32_t>(options.matrix)) +
           define("APSL_REGULARIZATION_PER_TRIANGLE", options.regularization_per_triangle ? 1 : 0);
}

apsl_parameters device_parameters(const Parameters& p) {
    return {p.time_step,
            1.0f / p.time_step,
            p.regularization,
            p.target_area_change,
            p.tolerance * p.tolerance,
            p.sub_steps,
            p.max_iterations,
            0};
}

/// Work-groups a launch: enough to fill the device and to share the load, few enough that every group can sum all
/// groups' partial results itself.
std::uint32_t group_count(const DeviceFacts& facts, const Options& options, const Adjacency& adjacency) {
    std::uint32_t largest = 1;
    for (const apsl_cloth& cloth : adjacency.cloths)
        largest = std::max({largest, cloth.triangle_count, cloth.vertex_count});
    // A group that has less to do than this costs more to start than it saves.
    const std::uint32_t least_share = std::max(options.work_group_size, 256u);
    return std::clamp((largest + least_share - 1) / least_share, 1u, facts.compute_units * 8);
}

void check_view(const BufferView& view, std::size_t floats, const char* name) {
    if (!view.buffer) invalid(std::string("buffers.") + name + " is null");
    if (view.offset % sizeof(float) != 0)
        invalid(std::string("buffers.") + name + " has offset " + std::to_string(view.offset) +
                ", expected a multiple of 4 bytes");
    std::size_t size = 0;
    check(clGetMemObjectInfo(view.buffer, CL_MEM_SIZE, sizeof size, &size, nullptr), "asking a buffer for its size");
    const std::size_t needed = floats * sizeof(float);
    // Subtracted rather than added: an offset near the end of the range must not wrap round.
    if (view.offset > size || size - view.offset < needed)
        invalid(std::string("buffers.") + name + " holds " + std::to_string(size) + " bytes, expected at least " +
                std::to_string(needed) + " from offset " + std::to_string(view.offset) + " on");
}

}  // namespace

struct StrainLimiter::Implementation {
    Implementation(cl_context context, cl_device_id device, std::span<const std::shared_ptr<const Topology>> cloths,
                   const Options& requested);

    BufferHandle buffer(std::size_t bytes, const void* contents = nullptr);
    template <class Value>
    BufferHandle upload(const std::vector<Value>& contents) {
        return buffer(contents.size() * sizeof(Value), contents.data());
    }
    /// The padding of these is read by vector loads and must hold numbers.
    BufferHandle zeroed_buffer(std::size_t floats) { return upload(std::vector<float>(floats, 0.0f)); }
    void bind_internal_arguments();
    void bind_caller_arguments(const Buffers& buffers);
    void check_buffers(const Buffers& buffers) const;
    void queue_parameters(CommandSequence& commands, std::span<const Parameters> parameters) const;
    void queue_solve(CommandSequence& commands, int iterations) const;
    cl_event enqueue(cl_command_queue queue, const Buffers& buffers, std::span<const Parameters> parameters,
                     std::span<const cl_event> wait_list);

    void launch(CommandSequence& commands, const Kernel& kernel) const {
        commands.launch(kernel, groups, options.work_group_size, cloth_count);
    }
    void launch_one_group(CommandSequence& commands, const Kernel& kernel) const {
        commands.launch(kernel, 1, options.work_group_size, cloth_count);
    }
    bool assembled() const { return options.apply == Apply::assembled_csr; }
    bool uses_pattern() const { return assembled() || options.matrix == Matrix::printed; }

    DeviceFacts facts;
    Options options;
    cl_context context;
    std::uint32_t cloth_count = 0, vertex_count = 0, triangle_count = 0, rest_area_count = 0, groups = 1;
    std::size_t bytes = 0;
    LaunchProfile profile;
    bool profiling = false;

    BufferHandle cloths, parameters, states, stats, partials;
    BufferHandle triangles, corner_offsets, corners, row_offsets, columns, shared, values;
    BufferHandle predicted, vertex_forces, gradients, residual, damped_diagonal, product, direction, direction_product,
        pressure;

    ProgramHandle program;
    Kernel predict_positions, assemble_gradients, measure_area_change, begin_solve, end_call;
    Kernel assemble_pressure_csr, gather_vertex_forces, apply_dot, cg_update, gather_displacements, update_velocities;
};

StrainLimiter::Implementation::Implementation(cl_context the_context, cl_device_id device,
                                              std::span<const std::shared_ptr<const Topology>> topologies,
                                              const Options& requested)
    : facts(device_facts(device)), options(resolve(requested, facts)), context(the_context) {
    if (topologies.empty()) invalid("no cloths given, expected at least one");
    for (const auto& topology : topologies)
        if (!topology) invalid("a cloth's topology is null");

    const Adjacency adjacency = build_adjacency(topologies, options.matrix, uses_pattern());
    cloth_count = static_cast<std::uint32_t>(adjacency.cloths.size());
    vertex_count = adjacency.vertex_count;
    triangle_count = adjacency.triangle_count;
    rest_area_count = adjacency.rest_area_count;
    groups = group_count(facts, options, adjacency);

    program = build_program(context, device, program_source(kernel_files(options)), build_options(options));

    cloths = upload(adjacency.cloths);
    parameters = buffer(cloth_count * sizeof(apsl_parameters));
    states = buffer(cloth_count * sizeof(apsl_solve_state));
    stats = buffer(cloth_count * sizeof(apsl_stats));
    partials = buffer(std::size_t{cloth_count} * groups * APSL_PARTIAL_KINDS * sizeof(float));
    triangles = upload(adjacency.triangles);
    corner_offsets = upload(adjacency.corner_offsets);
    corners = upload(adjacency.corners);
    predicted = buffer(std::size_t{vertex_count} * sizeof(cl_float4));
    gradients = buffer(std::size_t{triangle_count} * sizeof(cl_float8));
    const std::size_t per_triangle = std::size_t{triangle_count} * sizeof(float);
    residual = zeroed_buffer(triangle_count);
    damped_diagonal = zeroed_buffer(triangle_count);
    product = zeroed_buffer(triangle_count);
    direction = buffer(per_triangle);
    direction_product = buffer(per_triangle);
    pressure = buffer(per_triangle);
    if (uses_pattern()) {
        row_offsets = upload(adjacency.row_offsets);
        columns = upload(adjacency.columns);
        shared = upload(adjacency.shared);
    } else {
        vertex_forces = buffer(std::size_t{vertex_count} * sizeof(cl_float4));
    }
    if (assembled()) values = buffer(adjacency.columns.size() * sizeof(float));
    bind_internal_arguments();
}

BufferHandle StrainLimiter::Implementation::buffer(std::size_t size, const void* contents) {
    if (size > facts.max_allocation)
        throw Error(ErrorCode::unsupported, "a buffer of " + std::to_string(size) + " bytes is needed, device " +
                                                facts.name + " allows " + std::to_string(facts.max_allocation));
    cl_int status = CL_SUCCESS;
    BufferHandle handle(clCreateBuffer(context, CL_MEM_READ_WRITE | (contents ? CL_MEM_COPY_HOST_PTR : 0), size,
                                       const_cast<void*>(contents), &status));
    check(status, "allocating device memory");
    bytes += size;
    return handle;
}

void StrainLimiter::Implementation::bind_internal_arguments() {
    const auto kernel = [&](const char* name) { return create_kernel(program.get(), name); };
    predict_positions = kernel("predict_positions");
    set_arguments(predict_positions, 0, cloths, parameters, states, stats, predicted);
    assemble_gradients = kernel("assemble_gradients");
    set_arguments(assemble_gradients, 0, cloths, parameters, states, partials, triangles, predicted, gradients,
                  residual, damped_diagonal);
    measure_area_change = kernel("measure_area_change");
    set_arguments(measure_area_change, 0, cloths, partials, triangles, predicted);
    begin_solve = kernel("begin_solve");
    set_arguments(begin_solve, 0, parameters, states, stats, partials, groups);
    end_call = kernel("end_call");
    set_arguments(end_call, 0, stats, partials, groups);
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
        gather_vertex_forces = kernel("gather_vertex_forces");
        set_arguments(gather_vertex_forces, 0, cloths, parameters, states, partials, corner_offsets, corners, predicted,
                      gradients, residual, vertex_forces);
        apply_dot = kernel("matrix_free_apply_dot");
        set_arguments(apply_dot, 0, cloths, states, partials, triangles, gradients, vertex_forces, residual, product);
    }
    cg_update = kernel("cg_update");
    set_arguments(cg_update, 0, cloths, states, stats, partials, residual, damped_diagonal, product, direction,
                  direction_product, pressure);
    gather_displacements = kernel("gather_displacements");
    set_arguments(gather_displacements, 0, cloths, parameters, states, stats, partials, corner_offsets, corners,
                  gradients, pressure, predicted);
    update_velocities = kernel("update_velocities");
    set_arguments(update_velocities, 0, cloths, parameters, stats, predicted);
}

void StrainLimiter::Implementation::check_buffers(const Buffers& buffers) const {
    check_view(buffers.positions, std::size_t{vertex_count - 1} * options.position_stride + 3, "positions");
    check_view(buffers.velocities, std::size_t{vertex_count - 1} * options.velocity_stride + 3, "velocities");
    check_view(buffers.inverse_masses, vertex_count, "inverse_masses");
    check_view(buffers.rest_areas, rest_area_count, "rest_areas");
    if (options.regularization_per_triangle)
        check_view(buffers.regularization, rest_area_count, "regularization");
    else if (buffers.regularization.buffer)
        invalid("buffers.regularization is given, but Options::regularization_per_triangle is off");
}

void StrainLimiter::Implementation::bind_caller_arguments(const Buffers& buffers) {
    const auto bind = [](const Kernel& kernel, cl_uint first, const BufferView& view) {
        set_arguments(kernel, first, view.buffer, cl_ulong{view.offset / sizeof(float)});
    };
    bind(predict_positions, 5, buffers.positions);
    bind(predict_positions, 7, buffers.velocities);
    bind(predict_positions, 9, buffers.inverse_masses);
    bind(assemble_gradients, 9, buffers.rest_areas);
    bind(assemble_gradients, 11, buffers.regularization.buffer ? buffers.regularization : buffers.rest_areas);
    bind(measure_area_change, 4, buffers.rest_areas);
    bind(update_velocities, 4, buffers.positions);
    bind(update_velocities, 6, buffers.velocities);
}

void StrainLimiter::Implementation::queue_parameters(CommandSequence& commands,
                                                     std::span<const Parameters> given) const {
    // A fill takes its pattern at once, so nothing of the caller's has to outlive this call: one fill a run of equal
    // cloths.
    for (std::uint32_t begin = 0; begin < cloth_count;) {
        const apsl_parameters pattern = device_parameters(given.size() == 1 ? given[0] : given[begin]);
        std::uint32_t end = given.size() == 1 ? cloth_count : begin + 1;
        for (; end < cloth_count; ++end) {
            const apsl_parameters next = device_parameters(given[end]);
            if (std::memcmp(&pattern, &next, sizeof pattern) != 0) break;
        }
        commands.fill(this->parameters, &pattern, sizeof pattern, begin * sizeof pattern,
                      (end - begin) * sizeof pattern);
        begin = end;
    }
}

void StrainLimiter::Implementation::queue_solve(CommandSequence& commands, int iterations) const {
    launch(commands, assemble_gradients);
    launch_one_group(commands, begin_solve);
    if (assembled()) launch(commands, assemble_pressure_csr);
    for (cl_int k = 0; k < iterations; ++k) {
        if (gather_vertex_forces.handle) {
            set_argument(gather_vertex_forces, 10, k);
            launch(commands, gather_vertex_forces);
        } else {
            set_argument(apply_dot, assembled() ? 9 : 12, k);
        }
        launch(commands, apply_dot);
        set_argument(cg_update, 10, k);
        launch(commands, cg_update);
    }
    // The slot of the residual after the last iteration.
    set_argument(gather_displacements, 10, static_cast<cl_uint>(iterations & 1));
    launch(commands, gather_displacements);
}

cl_event StrainLimiter::Implementation::enqueue(cl_command_queue queue, const Buffers& buffers,
                                                std::span<const Parameters> given,
                                                std::span<const cl_event> wait_list) {
    if (given.size() != 1 && given.size() != cloth_count)
        invalid(std::to_string(given.size()) + " parameters given for " + std::to_string(cloth_count) +
                " cloths, expected one for each or a single one");
    int sub_steps = 0, iterations = 1;
    for (const Parameters& p : given) {
        validate(p);
        sub_steps = std::max(sub_steps, p.sub_steps);
        iterations = std::max(iterations, p.max_iterations);
    }
    check_buffers(buffers);
    bind_caller_arguments(buffers);

    CommandSequence commands(queue, wait_list, profiling ? &profile : nullptr);
    queue_parameters(commands, given);
    launch(commands, predict_positions);
    for (cl_int sub_step = 0; sub_step < sub_steps; ++sub_step) {
        set_argument(begin_solve, 5, sub_step);
        queue_solve(commands, iterations);
    }
    launch(commands, measure_area_change);
    launch_one_group(commands, end_call);
    if (sub_steps > 0) launch(commands, update_velocities);
    return commands.end();
}

StrainLimiter::StrainLimiter(cl_context context, cl_device_id device,
                             std::span<const std::shared_ptr<const Topology>> cloths, const Options& options)
    : implementation_(std::make_unique<Implementation>(context, device, cloths, options)) {
}

StrainLimiter::StrainLimiter(cl_context context, cl_device_id device, const std::shared_ptr<const Topology>& cloth,
                             const Options& options)
    : StrainLimiter(context, device, std::span(&cloth, 1), options) {
}

StrainLimiter::~StrainLimiter() = default;
StrainLimiter::StrainLimiter(StrainLimiter&&) noexcept = default;
StrainLimiter& StrainLimiter::operator=(StrainLimiter&&) noexcept = default;

std::size_t StrainLimiter::scratch_bytes() const noexcept {
    return implementation_->bytes;
}

std::size_t StrainLimiter::cloth_count() const noexcept {
    return implementation_->cloth_count;
}

const Options& StrainLimiter::options() const noexcept {
    return implementation_->options;
}

cl_event StrainLimiter::enqueue(cl_command_queue queue, const Buffers& buffers, std::span<const Parameters> parameters,
                                std::span<const cl_event> wait_list) {
    return implementation_->enqueue(queue, buffers, parameters, wait_list);
}

cl_event StrainLimiter::enqueue(cl_command_queue queue, const Buffers& buffers, const Parameters& parameters,
                                std::span<const cl_event> wait_list) {
    return implementation_->enqueue(queue, buffers, std::span(&parameters, 1), wait_list);
}

cl_event StrainLimiter::read_stats(cl_command_queue queue, std::span<Stats> stats,
                                   std::span<const cl_event> wait_list) const {
    if (stats.size() != implementation_->cloth_count)
        invalid(std::to_string(stats.size()) + " statistics asked for, expected one for each of " +
                std::to_string(implementation_->cloth_count) + " cloths");
    cl_event event = nullptr;
    check(clEnqueueReadBuffer(queue, implementation_->stats.get(), CL_FALSE, 0, stats.size_bytes(), stats.data(),
                              static_cast<cl_uint>(wait_list.size()), wait_list.empty() ? nullptr : wait_list.data(),
                              &event),
          "queueing the read of the statistics");
    return event;
}

void StrainLimiter::set_profiling(bool on) noexcept {
    implementation_->profiling = on;
}

std::vector<KernelTime> StrainLimiter::profile() {
    return implementation_->profile.collect();
}

}  // namespace apsl
