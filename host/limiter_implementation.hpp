// SPDX-License-Identifier: MIT
#pragma once

#include "adjacency.hpp"
#include "caller_buffers.hpp"
#include "device_arrays.hpp"
#include "device_facts.hpp"
#include "device_memory.hpp"
#include "handles.hpp"
#include "kernel_launch.hpp"
#include "limiter_kernels.hpp"
#include "program_binary.hpp"
#include "queued_iterations.hpp"
#include "resolved_parameters.hpp"

#include <apsl/strain_limiter.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace apsl {

/// The device side of a limiter: its arrays, its kernels, and the order of launches that makes Algorithm 1.
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
    /// Queues the launch of a kernel that computes `floats` numbers of the rest positions into `target`.
    template <class SetArguments>
    cl_event enqueue_rest(cl_command_queue queue, const BufferView& rest_positions, const BufferView& target,
                          std::size_t floats, const char* name, std::span<const cl_event> wait_list,
                          const SetArguments& set_arguments);
    cl_event enqueue_rest_areas(cl_command_queue queue, const BufferView& rest_positions, const BufferView& areas,
                                std::span<const cl_event> wait_list);
    cl_event enqueue_rest_shapes(cl_command_queue queue, const BufferView& rest_positions, const BufferView& shapes,
                                 std::span<const cl_event> wait_list);
    cl_event enqueue_rest_hinges(cl_command_queue queue, const BufferView& rest_positions, const BufferView& hinges,
                                 std::span<const cl_event> wait_list);

    host::DeviceFacts facts;
    Options options;
    cl_context context;
    cl_device_id device;
    std::uint32_t patch_vertex_room = 0;  ///< vertices of a patch that the program has room for
    std::uint32_t cloth_count = 0, vertex_count = 0, triangle_count = 0;
    host::CallerCounts caller_counts;
    std::size_t largest_cloth = 0;  ///< triangles
    host::DeviceMemory memory;
    host::DeviceArrays arrays;
    std::vector<ResolvedParameters> resolved;  ///< of the call at hand; room for one a cloth
    host::LaunchProfile profile;
    bool profiling = false;

    host::ProgramHandle program;
    host::Fingerprint program_fingerprint{};
    ProgramBinaryUse binary_use = ProgramBinaryUse::none_given;
    host::LimiterKernels kernels;

private:
    /// No program and no buffers yet.
    Implementation(cl_context context, cl_device_id device, const host::DeviceFacts& facts, const BufferView& scratch);
    /// Resolves the options on the way.
    host::Adjacency plan(std::span<const std::shared_ptr<const Topology>> cloths, const Options& requested);

    bool one_group() const { return options.execution == Execution::one_group; }
    bool by_chebyshev() const { return options.solver == Solver::chebyshev; }
    bool assembled() const { return options.apply == Apply::assembled_csr; }

    void create_program(std::uint32_t max_patch_vertices, std::span<const std::byte> binary);
    void share_program(const Implementation& built);
    void create_arrays(const host::Adjacency& adjacency);
    void queue_parameters(host::CommandSequence& commands, std::span<const ResolvedParameters> given) const;
    /// Iterations of a solve in sub-step `sub_step` that are queued.
    int solve_iterations(const host::CallBudget& budget, int sub_step) const;
    /// Throws Error(invalid_argument) where a call would queue more launches than most_launches.
    void check_launches(const host::CallBudget& budget) const;
    /// The matrix applied to an array, with its dot product.
    void queue_product(host::CommandSequence& commands, const host::BufferHandle& multiplied, cl_int iteration) const;
    void queue_guess(host::CommandSequence& commands, const host::BufferHandle& pressure) const;
    /// Assembles sub-step `sub_step` and decides whether it is done.
    void queue_assembly(host::CommandSequence& commands, cl_int sub_step) const;
    /// Leaves the bounds that sub-step `sub_step` scales the matrix by, of its own geometry.
    void queue_bound(host::CommandSequence& commands, cl_int sub_step) const;
    void queue_chebyshev(host::CommandSequence& commands, const Buffers& buffers, const host::CallBudget& budget,
                         cl_int sub_step) const;
    void queue_conjugate_gradient(host::CommandSequence& commands, const Buffers& buffers,
                                  const host::CallBudget& budget, cl_int sub_step) const;
    /// What bends in part `part` of the small steps.
    void queue_bending(host::CommandSequence& commands, const Buffers& buffers, const host::CallBudget& budget,
                       cl_int part) const;
    void queue_many_groups(host::CommandSequence& commands, const Buffers& buffers,
                           const host::CallBudget& budget) const;

    void launch(host::CommandSequence& commands, const host::Kernel& kernel) const {
        commands.launch(kernel, arrays.groups, options.work_group_size, cloth_count);
    }
    /// One group for each cloth.
    void launch_one_group(host::CommandSequence& commands, const host::Kernel& kernel) const {
        commands.launch(kernel, 1, options.work_group_size, cloth_count);
    }
};

}  // namespace apsl
