// SPDX-License-Identifier: MIT
#include "device_arrays.hpp"

#include "limiter_options.hpp"

#include <algorithm>

namespace apsl::host {
namespace {

// Bytes of a triangle's corner gradients (kernels/gradients.h).
constexpr std::size_t gradient_bytes = 32;
// Of a hinge's (kernels/hinges.h).
constexpr std::size_t hinge_gradient_bytes = 32;

}  // namespace

DeviceArrays make_device_arrays(DeviceMemory& memory, const Adjacency& adjacency, const Options& options,
                                std::uint32_t groups) {
    const auto buffer = [&](std::size_t size) { return memory.allocate(size, nullptr); };
    const auto upload = [&]<class Value>(const std::vector<Value>& contents) {
        return memory.allocate(contents.size() * sizeof(Value), contents.data());
    };
    // The padding of these is read by vector loads and must hold numbers.
    const auto zeroed = [&](std::size_t floats) { return upload(std::vector<float>(floats, 0.0f)); };
    const bool one_group = options.execution == Execution::one_group;
    const bool by_chebyshev = options.solver == Solver::chebyshev;
    const std::size_t cloth_count = adjacency.cloths.size();
    const std::size_t vertex_count = adjacency.vertex_count, triangle_count = adjacency.triangle_count;

    DeviceArrays arrays;
    arrays.groups = groups;
    arrays.cloths = upload(adjacency.cloths);
    arrays.parameters = buffer(cloth_count * sizeof(apslk_parameters));
    apslk_solve_state initial{};
    initial.adaptive_factor = 1.0f;
    arrays.states = upload(std::vector(cloth_count, initial));
    arrays.stats = upload(std::vector<apslk_stats>(cloth_count));  // of no call: zeros
    if (!one_group) arrays.partials = buffer(cloth_count * groups * APSLK_PARTIAL_KINDS * sizeof(float));

    arrays.vertex_order = upload(adjacency.vertex_order);
    arrays.triangle_order = upload(adjacency.triangle_order);
    arrays.triangles = upload(adjacency.triangles);
    arrays.corner_offsets = upload(adjacency.corner_offsets);
    arrays.corners = upload(adjacency.corners);
    if (uses_pattern(options)) {
        arrays.row_offsets = upload(adjacency.row_offsets);
        arrays.columns = upload(adjacency.columns);
        arrays.shared = upload(adjacency.shared);
    } else {
        arrays.patches = upload(adjacency.patches);
        arrays.patch_vertices = upload(adjacency.patch_vertices);
        arrays.local_triangles = upload(adjacency.local_triangles);
    }
    if (options.apply == Apply::assembled_csr) arrays.values = buffer(adjacency.columns.size() * sizeof(float));

    // Rows of areas and of stretches.
    const std::size_t row_count = triangle_count * (options.limits_stretch ? 2 : 1);
    arrays.ordered_rest = zeroed(triangle_count * (options.limits_stretch ? APSLK_CEILING + 1 : 1));
    arrays.ordered_scaling = upload(std::vector<float>(options.regularization_per_triangle ? triangle_count : 1, 1.0f));
    if (by_chebyshev) arrays.vertex_bounds = buffer(vertex_count * sizeof(float));
    const std::size_t hinge_count = adjacency.hinges.size();
    if (hinge_count > 0) {
        arrays.hinges = upload(adjacency.hinges);
        arrays.hinge_offsets = upload(adjacency.hinge_offsets);
        arrays.hinge_order = upload(adjacency.hinge_order);
        arrays.hinge_corner_offsets = upload(adjacency.hinge_corner_offsets);
        arrays.hinge_corners = upload(adjacency.hinge_corners);
        arrays.hinge_gradients = buffer(hinge_count * hinge_gradient_bytes);
        arrays.hinge_moments = buffer(hinge_count * sizeof(float));
        arrays.bending_residuals = buffer(vertex_count * sizeof(cl_float4));
        arrays.bending_steps = buffer(vertex_count * sizeof(cl_float4));
        arrays.next_bending_steps = buffer(vertex_count * sizeof(cl_float4));
    }
    arrays.moved = buffer(vertex_count * sizeof(cl_float4));
    const std::size_t moving_vertices = options.positions_only ? 1 : vertex_count;
    arrays.motion = buffer(moving_vertices * sizeof(cl_float4));
    arrays.total_correction = buffer(moving_vertices * sizeof(cl_float4));
    if (options.acceleration_per_vertex) arrays.accelerations = buffer(vertex_count * sizeof(cl_float4));
    const std::size_t error_runs = options.limits_stretch ? APSLK_HELD_EXCESS + 1 : 1;
    arrays.start_errors = zeroed(options.positions_only ? 1 : error_runs * triangle_count);
    arrays.gradients = buffer(row_count * gradient_bytes);
    arrays.residual = zeroed(row_count);
    arrays.scaled_diagonal = zeroed(row_count);
    arrays.direction = buffer(row_count * sizeof(float));
    if (!by_chebyshev) {
        arrays.product = zeroed(triangle_count);
        arrays.direction_product = buffer(triangle_count * sizeof(float));
    }
    if (one_group)
        arrays.pressures.push_back(zeroed(triangle_count * std::size_t{1 + options.warm_start_sub_steps}));
    else
        for (std::uint32_t n = 0; n < std::max(options.warm_start_sub_steps, 1u); ++n)
            arrays.pressures.push_back(zeroed(row_count));
    return arrays;
}

}  // namespace apsl::host
