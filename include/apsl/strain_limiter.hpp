// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/cxx20.hpp>
#include <apsl/error.hpp>
#include <apsl/export.hpp>
#include <apsl/options.hpp>
#include <apsl/parameters.hpp>
#include <apsl/stats.hpp>
#include <apsl/topology.hpp>
#include <apsl/version.hpp>

#include <CL/cl.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace apsl {

APSL_STRUCTS_BEGIN

/// A place in a caller's buffer. The element stride is fixed in Options.
struct BufferView {
    cl_mem buffer = nullptr;  ///< the caller's; must live until the calls that use it complete
    std::size_t offset = 0;   ///< bytes, a multiple of 4
};

/// 32-bit floats in the caller's buffers. With several cloths their vertices and triangles follow one another in the
/// order the cloths were given in. What a call writes shares no float with anything else that it uses.
struct Buffers {
    /// m, 3 floats every Options::position_stride, [V]; x̃, the start of the step; only read. With
    /// Options::integrates the start of the step in, its end out; with Options::positions_only its end, in and out.
    BufferView positions;
    /// m/s, 3 floats every Options::velocity_stride, [V]; ṽ in and out. Null with Options::positions_only.
    BufferView velocities;
    BufferView inverse_masses;       ///< 1/kg, 1 float every Options::inverse_mass_stride, [V], 0 pins a vertex
    BufferView rest_areas;           ///< m², [T]; 0 leaves a triangle alone, less is not legal
    BufferView regularization = {};  ///< α ≥ 1, [T], less counts as 1; only with Options::regularization_per_triangle
    /// 1/m, 4 floats a triangle, [T]: the inverse M of the 2×2 matrix whose columns are the triangle's rest edges
    /// x₁ − x₀ and x₂ − x₀ in its plane, row by row. The deformation gradient is F = [x₁ − x₀, x₂ − x₀] M. Zeros: no
    /// ceiling for this triangle. Only with Options::limits_stretch; see enqueue_rest_shapes.
    BufferView rest_shapes = {};
    /// ≥ 1.01, [T], less counts as 1.01; 0: no ceiling for this triangle. Only with
    /// Options::stretch_ceiling_per_triangle.
    BufferView stretch_ceilings = {};
    /// 8 floats a vertex, [V]: the plane that it may touch in this step. The outward unit normal n of a body's surface;
    /// offset d, m: at the end of the step the vertex lies at n·x ≥ d; the velocity u of the body there, m/s, 3 floats:
    /// a time t before the end the plane lies at d − t n·u; Coulomb's coefficient of friction, ≥ 0. A normal of zeros:
    /// nothing to touch. Only with Options::keeps_contacts.
    BufferView contacts = {};
    /// 2 floats a hinge, [H]: the angle between its triangles at rest, rad, and l²/(A₀ + A₁), l the length of its edge
    /// and A₀, A₁ the areas of its triangles at rest; a second number of 0 leaves a hinge free, a smaller one makes it
    /// softer. Hinges in the order of Topology::hinges; none is needed where there is no hinge. Only with
    /// Options::bends; see enqueue_rest_hinges.
    BufferView rest_hinges = {};
    /// m/s², [V], laid out as Options say of positions: what a vertex that is not pinned is accelerated by, beside
    /// Parameters::acceleration. Of a force f, N, on vertex i: f wᵢ. Only with Options::acceleration_per_vertex.
    BufferView accelerations = {};
    /// 32-bit unsigned integers, Options::tethers_per_vertex a vertex, [V]: the pinned vertices that a vertex is
    /// tethered to, as they lie in the buffers, of its own cloth. A vertex that is not pinned, and any other number,
    /// holds nothing. See tethers_to_pins.
    BufferView tether_anchors = {};
    /// m, likewise: how far from each it may be. 0, or what is no positive number: no tether.
    BufferView tether_lengths = {};
};

APSL_STRUCTS_END

/// What became of the program binary given to a StrainLimiter. Unless taken, the program was built from source.
enum class ProgramBinaryUse : std::int32_t {
    none_given = 0,         ///< no bytes
    taken = 1,              ///< nothing was compiled here
    not_a_binary = 2,       ///< not from StrainLimiter::program_binary, or of another format version
    other_program = 3,      ///< of other kernels, options, device or driver
    damaged = 4,            ///< its bytes have changed, or some are missing
    refused_by_driver = 5,  ///< sound as far as this library can tell
};

/// One kernel's share of the profiled commands (see StrainLimiter::profile).
struct KernelTime {
    std::string name;           ///< of the kernel, as in kernels/
    std::int64_t launches = 0;  ///< since the last call of profile()
    double seconds = 0.0;       ///< on the device, from the profiling events
};

/// The filter of Algorithm 1 on an OpenCL device, inside the caller's context, queue and buffers.
///
/// A call allocates nothing, waits for nothing and reads nothing back: every decision (convergence, the target, what
/// is not finite) is taken on the device. Same input, same device: same bytes. Not safe for use from two threads at
/// once: one limiter per thread. Any number of limiters may share a context.
class APSL_API StrainLimiter {
public:
    /// Compiles the kernels and uploads the adjacency of one or more cloths; this and rebuild() alone wait.
    /// Throws Error: invalid_argument (a device that is not in the context, no cloths, options out of range, scratch
    /// that is too small or not as said below), unsupported (the device lacks what the options ask for), kernel_build,
    /// opencl.
    /// `program_binary`: what program_binary() gave, tried in place of compiling; see program_binary_use().
    /// `scratch`: a place in a buffer of the caller's, itself no sub-buffer, CL_MEM_READ_WRITE without a CL_MEM_HOST_
    /// flag, with required_scratch_bytes() from its offset on, which is then all the device memory used; nobody else
    /// may write there while the limiter lives. Null: the limiter allocates its own.
    StrainLimiter(cl_context context, cl_device_id device, std::span<const std::shared_ptr<const Topology>> cloths,
                  const Options& options = {}, std::span<const std::byte> program_binary = {},
                  const BufferView& scratch = {});
    /// The same for one cloth.
    StrainLimiter(cl_context context, cl_device_id device, const std::shared_ptr<const Topology>& cloth,
                  const Options& options = {}, std::span<const std::byte> program_binary = {},
                  const BufferView& scratch = {});
    ~StrainLimiter();
    StrainLimiter(StrainLimiter&&) noexcept;             ///< what was moved from may only be assigned to or destroyed
    StrainLimiter& operator=(StrainLimiter&&) noexcept;  ///< likewise

    /// Bytes of `scratch` that a limiter for these cloths and options needs at any offset: what it holds, and the gaps
    /// that the device's alignment of sub-buffers makes. Works through the topologies, on the host.
    static std::size_t required_scratch_bytes(cl_device_id device,
                                              std::span<const std::shared_ptr<const Topology>> cloths,
                                              const Options& options = {});

    /// For other topologies, of as many cloths as there are now or another number: a tear, a garment put on. Options
    /// stay as resolved, and so does the compiled program, unless the new meshes' patches need more room than it has;
    /// device memory is allocated anew, and what was kept from call to call (pressures, raised α, statistics) is gone.
    /// Calls queued before complete undisturbed. Throws as the constructor does; the limiter then stays as it was.
    /// `scratch` as in the constructor; it may not overlap the present one.
    void rebuild(std::span<const std::shared_ptr<const Topology>> cloths, const BufferView& scratch = {});
    /// The same for one cloth.
    void rebuild(const std::shared_ptr<const Topology>& cloth, const BufferView& scratch = {});

    /// Device memory this object holds, adjacency included.
    std::size_t scratch_bytes() const noexcept;
    /// The cloths it was made for.
    std::size_t cloth_count() const noexcept;
    /// The options as resolved for the device (no zeros left).
    const Options& options() const noexcept;

    /// The compiled program, for the constructor of a later limiter with the same kernels, options, largest patch,
    /// device and driver. May take as long as compiling did. Best asked for after a call has completed, for some
    /// drivers compile at the first launch, and with no call pending, of this limiter or another of the same program:
    /// pocl 3.1 may abort the process over one. Empty where the driver gives none, and on pocl 6 with LLVM 18, which is
    /// not asked: it may abort the process whenever it is.
    std::vector<std::byte> program_binary() const;
    /// What became of the binary given to the constructor; none_given after a rebuild() that compiled.
    ProgramBinaryUse program_binary_use() const noexcept;

    /// Queues one filter call. `parameters` holds one entry for every cloth, or a single one for all.
    /// The queue may be in-order or out-of-order. The returned event completes with the call; the caller releases it.
    /// Throws Error(invalid_argument) before anything is queued: parameters out of range; a queue of another context or
    /// device; events of another context; buffers of another context, too small, or that kernels may not read or write
    /// as Buffers says. Throws Error(opencl) where a call fails.
    [[nodiscard]] cl_event enqueue(cl_command_queue queue, const Buffers& buffers,
                                   std::span<const Parameters> parameters, std::span<const cl_event> wait_list = {});
    /// The same with one set of parameters for all cloths.
    [[nodiscard]] cl_event enqueue(cl_command_queue queue, const Buffers& buffers, const Parameters& parameters,
                                   std::span<const cl_event> wait_list = {});

    /// Queues the areas of all triangles, m², [T], at `rest_positions` (m, [V], laid out as Options say of positions)
    /// into `rest_areas`: once, before the first call that reads them, where the rest state is given as positions.
    /// Queue, event and errors are as those of enqueue.
    [[nodiscard]] cl_event enqueue_rest_areas(cl_command_queue queue, const BufferView& rest_positions,
                                              const BufferView& rest_areas, std::span<const cl_event> wait_list = {});

    /// Queues Buffers::rest_shapes of all triangles at `rest_positions` likewise: 4 floats a triangle, [T]. Zeros where
    /// a triangle has no area. Only with Options::limits_stretch.
    [[nodiscard]] cl_event enqueue_rest_shapes(cl_command_queue queue, const BufferView& rest_positions,
                                               const BufferView& rest_shapes, std::span<const cl_event> wait_list = {});

    /// Queues Buffers::rest_hinges of all hinges at `rest_positions` likewise: 2 floats a hinge, [H], and nothing where
    /// there is no hinge. Zeros where a triangle of the hinge has no area. Only with Options::bends.
    [[nodiscard]] cl_event enqueue_rest_hinges(cl_command_queue queue, const BufferView& rest_positions,
                                               const BufferView& rest_hinges, std::span<const cl_event> wait_list = {});

    /// Queues a non-blocking read of the last call's statistics, one entry for every cloth. `stats` must live until the
    /// returned event completes; the caller releases it. On an out-of-order queue put enqueue's event into wait_list.
    /// Before the first call, and after a rebuild, all are zero.
    [[nodiscard]] cl_event read_stats(cl_command_queue queue, std::span<Stats> stats,
                                      std::span<const cl_event> wait_list = {}) const;

    /// While on, every launch on a queue with CL_QUEUE_PROFILING_ENABLE keeps its event, until profile() reads them.
    void set_profiling(bool on) noexcept;
    /// Waits for the launches since the last call and adds up their time by kernel. For benchmarks and reports.
    std::vector<KernelTime> profile();

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace apsl
