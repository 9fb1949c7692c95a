// SPDX-License-Identifier: MIT
#pragma once

#include "adjacency.hpp"
#include "device_memory.hpp"
#include "handles.hpp"

#include <apsl/strain_limiter.hpp>

#include <cstdint>
#include <vector>

namespace apsl::host {

/// A limiter's arrays on the device, by the names that kernels have for them. What the options do not need is empty.
struct DeviceArrays {
    std::uint32_t groups = 1;  ///< work-groups a launch: a partial result each in `partials`
    BufferHandle cloths, parameters, states, stats, partials;
    BufferHandle vertex_order, triangle_order, triangles, corner_offsets, corners;
    BufferHandle patches, patch_vertices, local_triangles;  ///< of the matrix applied from patches
    BufferHandle row_offsets, columns, shared, values;      ///< of the matrix applied by its pattern
    BufferHandle ordered_rest, ordered_scaling;
    BufferHandle accelerations;  ///< of Options::acceleration_per_vertex
    BufferHandle moved, motion, total_correction, start_errors, gradients, residual, scaled_diagonal;
    /// Of Options::bends.
    BufferHandle hinges, hinge_offsets, hinge_order, hinge_corner_offsets, hinge_corners, hinge_gradients,
        hinge_moments, bending_residuals, bending_steps, next_bending_steps;
    BufferHandle product, direction, direction_product, vertex_bounds;
    /// One for each sub-step whose pressures are kept, one alone where none are; in one_group all in a single buffer.
    std::vector<BufferHandle> pressures;
};

/// `options`: resolved. Throws as DeviceMemory::allocate.
DeviceArrays make_device_arrays(DeviceMemory& memory, const Adjacency& adjacency, const Options& options,
                                std::uint32_t groups);

}  // namespace apsl::host
