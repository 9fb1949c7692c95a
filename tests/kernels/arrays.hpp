// SPDX-License-Identifier: MIT
#pragma once

#include "host/adjacency.hpp"
#include "kernels/cloths.hpp"
#include "support/opencl.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace apsl::test {

/// Floats in a caller's buffer: from one element to the next, and before the first.
struct Placement {
    std::uint32_t stride = 3;
    std::uint64_t offset = 0;
};

/// A triangle's stored gradients (kernels/gradients.h): 16-bit fixed point.
struct Gradients {
    cl_short4 corner[3];  ///< w is zero
    float shift;          ///< (α − 1)/α
    float stiffening;     ///< √(α D) / A
};
static_assert(sizeof(Gradients) == 32);

/// The paper's: α = 1.2, ten sub-steps, all from the end of the step.
inline constexpr Parameters paper_setting{.regularization = 1.2f, .sub_steps = 10};

/// Every array of a limiter in guarded device memory, those of rows with room for a run of stretches, for one or more
/// cloths: inputs as the reference has them, outputs poisoned. A test overwrites what it wants otherwise.
struct Arrays {
    /// alpha as in `parameters` unless per triangle; the solve state is that of a solve about to begin.
    Arrays(std::span<const Cloth> cloths, Matrix matrix, const Parameters& parameters, std::uint32_t groups,
           bool alpha_per_triangle = false, Placement positions = {}, Placement velocities = {});

    std::span<const Cloth> sources;
    std::vector<ScaledSolve> solves;  ///< one a cloth
    host::Adjacency adjacency;
    std::vector<std::uint32_t> vertex_places;                 ///< the caller's vertex → its place in the arrays
    std::vector<std::vector<std::uint32_t>> triangle_places;  ///< likewise the triangles of each cloth
    std::uint32_t groups;
    Placement position_placement, velocity_placement;
    std::uint64_t array_offset;  ///< of inverse masses, rest areas and regularization, floats

    DeviceArray<apslk_cloth> cloths;
    DeviceArray<apslk_parameters> parameters;
    DeviceArray<apslk_solve_state> states;
    DeviceArray<apslk_stats> stats;
    DeviceArray<float> partials;
    DeviceArray<std::uint32_t> vertex_order, triangle_order, triangles, corner_offsets, corners, row_offsets, columns;
    DeviceArray<std::uint8_t> shared;
    DeviceArray<cl_uint2> patches;
    DeviceArray<std::uint32_t> patch_vertices;
    DeviceArray<std::uint16_t> local_triangles;
    DeviceArray<cl_float4> moved;                     ///< positions and inverse masses
    DeviceArray<cl_float4> motion, total_correction;  ///< of small steps
    DeviceArray<Gradients> gradients;
    DeviceArray<float> residual;  ///< the scaled right-hand side
    DeviceArray<float> scaled_diagonal;
    DeviceArray<float> values;   ///< the scaled matrix
    DeviceArray<float> product;  ///< poisoned, 0 in the padding; the rest is poisoned there too
    DeviceArray<float> direction, direction_product, pressure;
    DeviceArray<float> vertex_bounds;                  ///< of bound_vertices
    DeviceArray<float> start_errors;                   ///< of measure_step
    DeviceArray<float> ordered_rest, ordered_scaling;  ///< what order_triangle_values makes
    DeviceArray<float> caller_positions, caller_velocities, inverse_masses, rest_areas, regularization;
    DeviceArray<cl_uint4> hinges;
    DeviceArray<std::uint32_t> hinge_offsets, hinge_order, hinge_corner_offsets, hinge_corners;
    DeviceArray<cl_float4> hinge_gradients;  ///< two a hinge
    DeviceArray<float> hinge_moments;
    DeviceArray<cl_float4> bending_residuals, bending_steps, next_bending_steps;
    DeviceArray<float> rest_hinges;                              ///< the caller's
    DeviceArray<float> rest_shapes, stretch_ceilings, contacts;  ///< the caller's too
    DeviceArray<cl_float4> accelerations;                        ///< what predict_positions makes
    DeviceArray<float> caller_accelerations;                     ///< placed as the positions are

    std::size_t cloth_count() const { return sources.size(); }
    /// The cloth's numbers out of an array over (padded) triangles, in the caller's order.
    std::vector<double> of_cloth(const std::vector<float>& per_triangle, std::size_t cloth) const;
    /// What an array over triangles holds in the padding.
    std::vector<float> padding_of(const std::vector<float>& per_triangle) const;
    /// What order_triangle_values and order_stretch_limits make of the cloths.
    std::vector<float> ordered_rest_values() const;
    /// A run of areas with poisoned ones of stretches after it.
    template <class Value>
    static std::vector<Value> with_stretches(std::vector<Value> areas, std::size_t runs = 1) {
        const std::vector<Value> more = poison<Value>(runs * areas.size());
        areas.insert(areas.end(), more.begin(), more.end());
        return areas;
    }
    /// Every bit set, but 0 in the padding: what the host sees to.
    std::vector<float> poisoned_triangles() const;
    /// One number a triangle (in the caller's order) for every cloth, as the kernels lay them out; 0 in the padding.
    std::vector<float> over_triangles(const std::function<double(std::size_t cloth, std::size_t a)>& value) const;
    /// ‖r‖² in m⁴ of the scaled residual r̄ at hand.
    double unscaled_squared(std::size_t cloth, const std::vector<double>& scaled) const;
    /// A kind's partial results of a cloth, one for each group.
    std::vector<double> partials_of(std::size_t cloth, int kind) const;
    void write_partials(std::size_t cloth, int kind, const std::vector<double>& values);
    /// Puts the sum into the first group's place, 0 into the others.
    void write_partial_sum(std::size_t cloth, int kind, double sum);
    /// Rewrites each cloth's state.
    void edit_states(const std::function<void(apslk_solve_state&)>& edit);
};

}  // namespace apsl::test
