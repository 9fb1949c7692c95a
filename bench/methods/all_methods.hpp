// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

/// Every baseline, by its file's name.
namespace apsl::methods {

/// Principal stretches of every triangle held in [1 − limit, 1 + limit]; parameters: iterations, limit.
MethodInfo continuum_strain_limiting_info();

/// Parameters: iterations; limit, the strain s in [0, 1) that edges may have.
MethodInfo edge_limits_gauss_seidel_info();

/// Parameters: iterations; limit, the strain s in [0, 1) that edges may have.
MethodInfo edge_limits_jacobi_info();

/// All edges at rest length, one sparse direct solve an iteration; parameters: iterations, tolerance, regularization,
/// quads.
MethodInfo fast_projection_info();

/// Lagrange multipliers of all edge lengths of a level at once, level by level; parameters: iterations (of the linear
/// solver, on each level), levels, passes.
MethodInfo hierarchical_constraints_info();

/// Edges at rest length, level by level; parameters: iterations (on each level), levels.
MethodInfo hierarchical_pbd_info();

/// Inextensible triangles between edge midpoints; parameters: iterations (on the midpoints), passes (midpoints and
/// back).
MethodInfo nonconforming_edge_midpoint_info();

/// Parameters: iterations.
MethodInfo pbd_area_colored_info();

/// Parameters: iterations.
MethodInfo pbd_area_gauss_seidel_info();

/// Parameters: iterations.
MethodInfo pbd_area_jacobi_info();

/// Parameters: iterations; stiffness, k in [0, 1].
MethodInfo pbd_edges_info();

/// Parameters: iterations.
MethodInfo ring_area_info();

/// Stretch and shear of every triangle; parameters: iterations.
MethodInfo strain_based_dynamics_strain_info();

/// Area of every triangle alone; parameters: iterations.
MethodInfo strain_based_dynamics_area_info();

/// Parameters: iterations; compliance, m³/N.
MethodInfo xpbd_area_info();

/// Parameters: iterations; compliance, m/N.
MethodInfo xpbd_edges_info();

}  // namespace apsl::methods
