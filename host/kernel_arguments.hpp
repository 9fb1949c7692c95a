// SPDX-License-Identifier: MIT
//
// Every kernel's argument list, once. A function gives the kernel of its name all its arguments, in the kernel's order,
// and returns it for the launch. `Arrays` is DeviceArrays, or what has members of the same names: a test's arrays.
#pragma once

#include "caller_buffers.hpp"
#include "kernel_launch.hpp"
#include "kernels/layout.h"

#include <tuple>

namespace apsl::host::arguments {

/// `array` where each vertex has an acceleration of its own, for a kernel that has an argument for it only then.
template <class Array>
const Array* where_accelerated(const Array& array, const Buffers& caller) {
    return caller.accelerations.buffer ? &array : nullptr;
}

/// The last arguments of kernels that keep vertices within reach, which they have only where there are tethers
/// (APSLK_TETHERS_ARGUMENT).
inline auto tethers(const Buffers& caller) {
    const auto where_tethered = [&](const BufferView& view) { return caller.tether_anchors.buffer ? &view : nullptr; };
    return std::tuple(where_tethered(caller.tether_anchors), where_tethered(caller.tether_lengths),
                      where_tethered(caller.positions), where_tethered(caller.velocities),
                      where_tethered(caller.inverse_masses));
}

template <class Arrays>
const Kernel& set_parameters(const Kernel& kernel, const Arrays& a, const apslk_parameter_block& block, cl_uint first,
                             cl_uint count) {
    return set_arguments(kernel, a.parameters, block, first, count);
}

template <class Arrays>
const Kernel& rest_areas(const Kernel& kernel, const Arrays& a, const BufferView& rest_positions,
                         const BufferView& areas) {
    return set_arguments(kernel, a.cloths, a.vertex_order, a.triangle_order, a.triangles, rest_positions, areas);
}

template <class Arrays>
const Kernel& rest_shapes(const Kernel& kernel, const Arrays& a, const BufferView& rest_positions,
                          const BufferView& shapes) {
    return set_arguments(kernel, a.cloths, a.vertex_order, a.triangle_order, a.triangles, rest_positions, shapes);
}

template <class Arrays>
const Kernel& rest_hinges(const Kernel& kernel, const Arrays& a, const BufferView& rest_positions,
                          const BufferView& rest_hinges) {
    return set_arguments(kernel, a.hinge_offsets, a.vertex_order, a.hinge_order, a.hinges, rest_positions, rest_hinges);
}

/// `part`: of the small steps.
template <class Arrays>
const Kernel& bend_hinges(const Kernel& kernel, const Arrays& a, const Buffers& caller, cl_int part) {
    return set_arguments(kernel, a.parameters, a.states, a.partials, a.hinge_offsets, a.hinge_order, a.hinges,
                         a.hinge_corner_offsets, a.moved, a.motion, a.hinge_gradients, a.hinge_moments,
                         caller.rest_hinges, part, where_accelerated(a.accelerations, caller));
}

template <class Arrays>
const Kernel& bend_vertices(const Kernel& kernel, const Arrays& a, cl_int part, cl_int iteration) {
    const bool even = iteration % 2 == 0;
    return set_arguments(kernel, a.cloths, a.parameters, a.states, a.hinges, a.hinge_corner_offsets, a.hinge_corners,
                         a.hinge_gradients, a.hinge_moments, a.bending_residuals,
                         even ? a.bending_steps : a.next_bending_steps, even ? a.next_bending_steps : a.bending_steps,
                         a.moved, a.motion, part, iteration);
}

template <class Arrays>
const Kernel& predict_positions(const Kernel& kernel, const Arrays& a, const Buffers& caller) {
    return set_arguments(kernel, a.cloths, a.parameters, a.states, a.stats, a.partials, a.vertex_order, a.moved,
                         a.motion, caller.positions, corrected(caller), caller.inverse_masses,
                         or_any(caller.contacts, caller), where_accelerated(a.accelerations, caller),
                         where_accelerated(caller.accelerations, caller));
}

template <class Arrays>
const Kernel& order_triangle_values(const Kernel& kernel, const Arrays& a, const Buffers& caller) {
    return set_arguments(kernel, a.cloths, a.parameters, a.triangle_order, a.ordered_rest, a.ordered_scaling,
                         caller.rest_areas, or_any(caller.regularization, caller));
}

template <class Arrays>
const Kernel& order_stretch_limits(const Kernel& kernel, const Arrays& a, const Buffers& caller) {
    return set_arguments(kernel, a.cloths, a.parameters, a.triangle_order, a.ordered_rest, caller.rest_shapes,
                         or_any(caller.stretch_ceilings, caller));
}

template <class Arrays>
const Kernel& measure_step(const Kernel& kernel, const Arrays& a) {
    return set_arguments(kernel, a.cloths, a.parameters, a.partials, a.triangles, a.moved, a.motion, a.ordered_rest,
                         a.start_errors);
}

template <class Arrays>
const Kernel& judge_whole_step(const Kernel& kernel, const Arrays& a) {
    return set_arguments(kernel, a.parameters, a.states, a.stats, a.partials, a.groups);
}

template <class Arrays>
const Kernel& start_small_steps(const Kernel& kernel, const Arrays& a, const Buffers& caller) {
    return set_arguments(kernel, a.cloths, a.parameters, a.states, a.vertex_order, a.moved, a.motion,
                         a.total_correction, caller.velocities, where_accelerated(a.accelerations, caller),
                         tethers(caller));
}

template <class Arrays>
const Kernel& assemble_gradients(const Kernel& kernel, const Arrays& a, bool by_chebyshev, cl_int sub_step,
                                 cl_int for_solve) {
    return set_arguments(kernel, a.cloths, a.parameters, a.states, a.partials, a.triangles, a.moved, a.gradients,
                         a.residual, a.scaled_diagonal, a.ordered_rest,
                         by_chebyshev ? a.vertex_bounds : a.ordered_scaling, a.start_errors, sub_step, for_solve);
}

template <class Arrays>
const Kernel& begin_solve(const Kernel& kernel, const Arrays& a, cl_int sub_step) {
    return set_arguments(kernel, a.parameters, a.states, a.stats, a.partials, a.groups, sub_step);
}

template <class Arrays>
const Kernel& assemble_pressure_csr(const Kernel& kernel, const Arrays& a) {
    return set_arguments(kernel, a.cloths, a.states, a.triangles, a.moved, a.gradients, a.row_offsets, a.columns,
                         a.shared, a.values);
}

/// `multiplied`: the array that the matrix is applied to.
template <class Arrays, class Array>
const Kernel& csr_spmv_dot(const Kernel& kernel, const Arrays& a, const Array& multiplied, cl_int iteration) {
    return set_arguments(kernel, a.cloths, a.parameters, a.states, a.partials, a.row_offsets, a.columns, a.values,
                         multiplied, a.product, iteration);
}

template <class Arrays, class Array>
const Kernel& matrix_free_printed(const Kernel& kernel, const Arrays& a, const Array& multiplied, cl_int iteration) {
    return set_arguments(kernel, a.cloths, a.parameters, a.states, a.partials, a.triangles, a.moved, a.gradients,
                         a.row_offsets, a.columns, a.shared, multiplied, a.product, iteration);
}

template <class Arrays, class Array>
const Kernel& matrix_free_consistent(const Kernel& kernel, const Arrays& a, const Array& multiplied, cl_int iteration) {
    return set_arguments(kernel, a.cloths, a.parameters, a.states, a.partials, a.patches, a.patch_vertices,
                         a.local_triangles, a.corner_offsets, a.corners, a.gradients, multiplied, a.product, iteration);
}

template <class Arrays, class Array>
const Kernel& measure_guess(const Kernel& kernel, const Arrays& a, const Array& pressure) {
    return set_arguments(kernel, a.cloths, a.states, a.partials, a.residual, pressure);
}

template <class Arrays, class Array>
const Kernel& start_from_guess(const Kernel& kernel, const Arrays& a, const Array& pressure) {
    return set_arguments(kernel, a.cloths, a.states, a.partials, a.residual, a.scaled_diagonal, a.product, pressure);
}

template <class Arrays, class Array>
const Kernel& cg_update(const Kernel& kernel, const Arrays& a, const Array& pressure, cl_int iteration) {
    return set_arguments(kernel, a.cloths, a.states, a.partials, a.residual, a.scaled_diagonal, a.product, a.direction,
                         a.direction_product, pressure, iteration);
}

/// `iterations`: those queued before.
template <class Arrays, class Array>
const Kernel& finish_solve(const Kernel& kernel, const Arrays& a, const Array& pressure, cl_int iterations) {
    return set_arguments(kernel, a.cloths, a.parameters, a.states, a.partials, a.patches, a.patch_vertices,
                         a.local_triangles, a.corner_offsets, a.corners, a.gradients, a.residual, a.scaled_diagonal,
                         a.product, a.direction, a.direction_product, pressure, a.groups, iterations);
}

template <class Arrays>
const Kernel& bound_vertices(const Kernel& kernel, const Arrays& a) {
    return set_arguments(kernel, a.cloths, a.parameters, a.states, a.corner_offsets, a.corners, a.gradients, a.moved,
                         a.motion, a.vertex_bounds);
}

/// Launch `launch` of `launched`. The last one writes the pressure; those before it take turns with the direction.
template <class Arrays, class Array>
const Kernel& chebyshev_step(const Kernel& kernel, const Arrays& a, const Array& pressure, cl_int sub_step,
                             cl_int launched, cl_int launch) {
    const bool to_pressure = (launched - 1 - launch) % 2 == 0;
    return set_arguments(kernel, a.cloths, a.parameters, a.states, a.patches, a.patch_vertices, a.local_triangles,
                         a.corner_offsets, a.corners, a.gradients, a.residual, to_pressure ? a.direction : pressure,
                         to_pressure ? pressure : a.direction, sub_step, launched, launch);
}

/// `slot`: of the last iteration's residual, 0 even, 1 odd.
template <class Arrays, class Array>
const Kernel& gather_displacements(const Kernel& kernel, const Arrays& a, const Buffers& caller, const Array& pressure,
                                   cl_int sub_step, cl_uint slot) {
    return set_arguments(kernel, a.cloths, a.parameters, a.states, a.stats, a.partials, a.corner_offsets, a.corners,
                         a.gradients, pressure, a.moved, a.motion, a.total_correction, a.vertex_order,
                         or_any(caller.contacts, caller), sub_step, slot, where_accelerated(a.accelerations, caller),
                         tethers(caller));
}

/// `pressure`: of the last sub-step.
template <class Arrays, class Array>
const Kernel& measure_area_change(const Kernel& kernel, const Arrays& a, const Array& pressure) {
    return set_arguments(kernel, a.cloths, a.parameters, a.partials, a.triangles, a.moved, a.motion, a.ordered_rest,
                         pressure, a.start_errors);
}

template <class Arrays>
const Kernel& measure_energy(const Kernel& kernel, const Arrays& a, const Buffers& caller) {
    return set_arguments(kernel, a.cloths, a.parameters, a.states, a.partials, a.vertex_order, a.moved, a.motion,
                         caller.positions, caller.velocities, or_any(caller.contacts, caller),
                         where_accelerated(a.accelerations, caller));
}

template <class Arrays>
const Kernel& end_call(const Kernel& kernel, const Arrays& a) {
    return set_arguments(kernel, a.cloths, a.parameters, a.states, a.stats, a.partials, a.vertex_order,
                         a.triangle_order, a.triangles, a.moved, a.ordered_rest, a.groups);
}

template <class Arrays>
const Kernel& update_velocities(const Kernel& kernel, const Arrays& a, const Buffers& caller) {
    return set_arguments(kernel, a.cloths, a.parameters, a.states, a.stats, a.vertex_order, a.moved, a.total_correction,
                         caller.positions, corrected(caller), or_any(caller.contacts, caller));
}

template <class Arrays>
const Kernel& store_step(const Kernel& kernel, const Arrays& a, const Buffers& caller) {
    return set_arguments(kernel, a.cloths, a.parameters, a.states, a.stats, a.vertex_order, a.moved, a.motion,
                         caller.positions, caller.velocities, or_any(caller.contacts, caller),
                         where_accelerated(a.accelerations, caller));
}

/// `pressure_stride`: from one kept pressure to the next, triangles.
template <class Arrays, class Array>
const Kernel& filter_in_one_group(const Kernel& kernel, const Arrays& a, const Array& pressure, const Buffers& caller,
                                  cl_uint pressure_stride) {
    return set_arguments(kernel, a.cloths, a.parameters, a.states, a.stats, a.vertex_order, a.triangle_order,
                         a.triangles, a.patches, a.patch_vertices, a.local_triangles, a.corner_offsets, a.corners,
                         a.moved, a.motion, a.total_correction, a.gradients, a.residual, a.scaled_diagonal, a.product,
                         a.direction, a.direction_product, pressure, a.ordered_rest, a.ordered_scaling, a.start_errors,
                         caller.positions, corrected(caller), caller.inverse_masses, caller.rest_areas,
                         or_any(caller.regularization, caller), pressure_stride);
}

}  // namespace apsl::host::arguments
