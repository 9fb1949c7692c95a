// SPDX-License-Identifier: MIT
#pragma once

#include "device_facts.hpp"
#include "device_memory.hpp"
#include "handles.hpp"
#include "kernel_launch.hpp"
#include "limiter_plan.hpp"
#include "program_binary.hpp"
#include "queued_iterations.hpp"

#include <apsl/strain_limiter.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace apsl {

/// The device side of a limiter: its buffers, its kernels, and the order of launches that makes Algorithm 1.
/// A kernel or buffer that the options do not need stays empty.
struct StrainLimiter::Implementation {
    /// With the program of `built` where it fits; `built` may be null.
    Implementation(cl_context context, cl_device_id device, std::span<const std::shared_ptr<const Topology>> cloths,
                   const Options& requested, std::span<const std::byte> program_binary, const BufferView& scratch,
                   const Implementation* built = nullptr);
    static std::size_t required_scratch_bytes(cl_device_id device,
                                              std::span<const std::shared_ptr<const Topology>> cloths,
                                              const Options& requested);

    std::vector<std::byte> program_binary() const;

    cl_event enqueue(cl_command_queue queue, const Buffers& buffers, std::span<const Parameters> parameters,
                     std::span<const cl_event> wait_list);
    cl_event enqueue_rest_areas(cl_command_queue queue, const BufferView& rest_positions, const BufferView& areas,
                                std::span<const cl_event> wait_list);

    host::DeviceFacts facts;
    Options options;
    cl_context context;
    cl_device_id device;
    std::uint32_t patch_vertex_room = 0;  ///< vertices of a patch that the program has room for
    std::uint32_t cloth_count = 0, vertex_count = 0, triangle_count = 0, rest_area_count = 0, groups = 1;
    std::size_t largest_cloth = 0;  ///< triangles
    host::DeviceMemory memory;
    host::LaunchProfile profile;
    bool profiling = false;

    host::BufferHandle cloths, parameters, states, stats, partials;
    host::BufferHandle vertex_order, triangle_order, ordered_rest_areas, ordered_regularization, triangles,
        corner_offsets, corners;
    host::BufferHandle patches, patch_vertices, local_triangles, row_offsets, columns, shared, values;
    host::BufferHandle predicted, motion, correction, start_errors, gradients, residual, damped_diagonal, product,
        direction, direction_product, vertex_bounds;
    /// One for each sub-step whose pressures are kept, one alone where none are; in one_group all in a single buffer.
    std::vector<host::BufferHandle> pressures;

    host::ProgramHandle program;
    host::Fingerprint program_fingerprint{};
    ProgramBinaryUse binary_use = ProgramBinaryUse::none_given;
    host::Kernel set_parameters, rest_areas, predict_positions, order_triangle_values, assemble_gradients, measure_step,
        measure_area_change, begin_call, start_walk, begin_solve, end_call;
    host::Kernel assemble_pressure_csr, apply_dot, cg_update, finish_solve, gather_displacements, update_velocities;
    host::Kernel measure_guess, start_from_guess;
    host::Kernel bound_vertices, chebyshev_step;
    host::Kernel filter_in_one_group;

private:
    /// No program and no buffers yet.
    Implementation(cl_context context, cl_device_id device, const host::DeviceFacts& facts, const BufferView& scratch);
    /// Resolves the options on the way.
    host::Adjacency plan(std::span<const std::shared_ptr<const Topology>> cloths, const Options& requested);

    bool one_group() const { return options.execution == Execution::one_group; }
    bool by_chebyshev() const { return options.solver == Solver::chebyshev; }
    bool assembled() const { return options.apply == Apply::assembled_csr; }

    host::BufferHandle buffer(std::size_t size, const void* contents = nullptr) {
        return memory.allocate(size, contents);
    }
    template <class Value>
    host::BufferHandle upload(const std::vector<Value>& contents) {
        return buffer(contents.size() * sizeof(Value), contents.data());
    }
    /// The padding of these is read by vector loads and must hold numbers.
    host::BufferHandle zeroed_buffer(std::size_t floats) { return upload(std::vector<float>(floats, 0.0f)); }

    void create_program(std::uint32_t max_patch_vertices, std::span<const std::byte> binary);
    void share_program(const Implementation& built);
    void create_buffers(const host::Adjacency& adjacency);
    void create_kernels();
    void create_apply_kernels();
    void create_conjugate_gradient();
    void create_chebyshev();
    /// From the first of the caller's positions to the last.
    std::size_t position_floats() const;
    void check_buffers(const Buffers& buffers) const;
    void bind(const Buffers& buffers) const;
    /// With `automatic` replaced where the options leave no choice.
    Parameters as_run(Parameters given) const;
    void queue_parameters(host::CommandSequence& commands, std::span<const Parameters> given) const;
    void use_pressures(const host::BufferHandle& pressure) const;
    void queue_guess(host::CommandSequence& commands, const host::BufferHandle& pressure) const;
    /// Assembles sub-step `sub_step` and decides whether it is done.
    void queue_assembly(host::CommandSequence& commands, int sub_step) const;
    /// Leaves the bounds that sub-step `sub_step` scales the matrix by: of the geometry before, or of its own where it
    /// is the first.
    void queue_bound(host::CommandSequence& commands, int sub_step) const;
    void queue_chebyshev(host::CommandSequence& commands, const host::CallBudget& budget, int sub_step) const;
    void queue_conjugate_gradient(host::CommandSequence& commands, const host::CallBudget& budget, int sub_step) const;
    void queue_displacements(host::CommandSequence& commands, int sub_step, cl_uint slot) const;
    void queue_many_groups(host::CommandSequence& commands, const host::CallBudget& budget) const;

    void launch(host::CommandSequence& commands, const host::Kernel& kernel) const {
        commands.launch(kernel, groups, options.work_group_size, cloth_count);
    }
    /// One group for each cloth.
    void launch_one_group(host::CommandSequence& commands, const host::Kernel& kernel) const {
        commands.launch(kernel, 1, options.work_group_size, cloth_count);
    }
};

}  // namespace apsl
