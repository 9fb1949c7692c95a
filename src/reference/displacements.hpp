// SPDX-License-Identifier: MIT
#pragma once

#include "reference/geometry.hpp"

#include <apsl/topology.hpp>

#include <span>
#include <vector>

namespace apsl::reference {

/// Eq. (6) with λ_a = p_a Δt²: Δx_i = −w_i Σ_{a∋i} λ_a g_{a,i}, gathered over the corners at each vertex in ascending
/// order. lambda in kg, [T]; displacements in m, [3V], zero for w_i = 0 and for vertices in no triangle.
template <class Real>
void displacements(const Topology& topology, std::span<const TriangleGeometry<Real>> geometry,
                   std::span<const Real> inverse_masses, std::span<const Real> lambda,
                   std::vector<Real>& displacements);

}  // namespace apsl::reference
