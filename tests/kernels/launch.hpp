// SPDX-License-Identifier: MIT
//
// Each function builds the kernel's own file alone, launches it over all cloths of the arrays and waits.
#pragma once

#include "kernels/arrays.hpp"

#include <cstdint>
#include <vector>

namespace apsl::test {

/// What a kernel is compiled for; strides and per-triangle α come from the arrays and from `alpha_per_triangle`.
struct Build {
    std::uint32_t work_group_size = 64;
    Matrix matrix = Matrix::consistent;
    bool alpha_per_triangle = false;
    bool chebyshev = false;
    bool limits_stretch = false;  ///< with a ceiling of its own for each triangle
    bool integrates = false;
    bool keeps_contacts = false;
    bool bends = false;
    bool acceleration_per_vertex = false;
};

/// 1 and 64 work-items a group, thorough() 1, 32, 64 and 256, as far as the device goes.
std::vector<std::uint32_t> work_group_sizes();
/// 1, one below, at and above a group's size, and many.
std::vector<std::uint32_t> awkward_sizes(std::uint32_t work_group_size);

namespace launch {

void set_parameters(Arrays& arrays, const Build& build, const apslk_parameter_block& block, std::uint32_t first,
                    std::uint32_t count);
void predict_positions(Arrays& arrays, const Build& build);
/// Of the caller's positions, into the caller's rest areas.
void rest_areas(Arrays& arrays, const Build& build);
/// Likewise into the caller's rest shapes.
void rest_shapes(Arrays& arrays, const Build& build);
/// Likewise into the caller's rest hinges.
void rest_hinges(Arrays& arrays, const Build& build);
/// Of part `part` of the small steps.
void bend_hinges(Arrays& arrays, const Build& build, int part);
void bend_vertices(Arrays& arrays, const Build& build, int part, int iteration);
void order_triangle_values(Arrays& arrays, const Build& build);
void order_stretch_limits(Arrays& arrays, const Build& build);
void assemble_gradients(Arrays& arrays, const Build& build, int sub_step = 0, bool for_solve = true);
void measure_area_change(Arrays& arrays, const Build& build);
void measure_step(Arrays& arrays, const Build& build);
void judge_whole_step(Arrays& arrays, const Build& build);
void start_small_steps(Arrays& arrays, const Build& build);
void begin_solve(Arrays& arrays, const Build& build, int sub_step);
void end_call(Arrays& arrays, const Build& build);
void assemble_pressure_csr(Arrays& arrays, const Build& build);
void csr_spmv_dot(Arrays& arrays, const Build& build, int iteration);
void matrix_free_apply_dot(Arrays& arrays, const Build& build, int iteration);
void measure_guess(Arrays& arrays, const Build& build);
void start_from_guess(Arrays& arrays, const Build& build);
void cg_update(Arrays& arrays, const Build& build, int iteration);
void bound_vertices(Arrays& arrays, const Build& build);
/// Launch `launch` of `launched`; the last writes the pressure, those before it take turns with the direction.
void chebyshev_step(Arrays& arrays, const Build& build, int sub_step, int launched, int launch);
/// `iterations`: those done before.
void finish_solve(Arrays& arrays, const Build& build, int iterations);
void gather_displacements(Arrays& arrays, const Build& build, std::uint32_t slot, int sub_step = 0);
void update_velocities(Arrays& arrays, const Build& build);
void measure_energy(Arrays& arrays, const Build& build);
void store_step(Arrays& arrays, const Build& build);
void filter_in_one_group(Arrays& arrays, const Build& build);

}  // namespace launch
}  // namespace apsl::test
