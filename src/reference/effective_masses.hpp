// SPDX-License-Identifier: MIT
#pragma once

#include "reference/geometry.hpp"

#include <apsl/topology.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace apsl::reference {

/// K_i = Σ_{a∋i} max(λ_a, 0) |g_{a,i}|² / (2 A_a), kg: what the tension of the triangles around vertex i resists its
/// motion across them with, in a sub-step (the diagonal of their geometric stiffness times the square of its length,
/// docs/formulation.md). Triangles without area add nothing.
template <class Real>
Real geometric_stiffness(const Topology& topology, std::span<const TriangleGeometry<Real>> geometry,
                         std::span<const Real> lambda, std::size_t vertex);

/// The mass that a vertex of mass `mass` has in a sub-step where tension holds it with `stiffness`, at most `greatest`
/// or its own. All kg.
template <class Real>
Real effective_mass(Real mass, Real stiffness, Real greatest);

/// The greatest effective mass in a cloth: ten times the geometric mean of its movable vertices' masses, which neither
/// a few heavy vertices nor many light ones move far. kg; 0 where none is movable.
template <class Real>
Real greatest_effective_mass(std::span<const Real> inverse_masses);

/// What the vertices weigh in the sub-steps of one call.
template <class Real>
struct EffectiveMasses {
    std::vector<Real> inverse;    ///< 1/kg, [V], w'
    std::vector<Real> tension;    ///< kg, [V], K of the last solve
    std::vector<Real> stiffness;  ///< kg, [V], the K that is kept
    Real greatest = Real(0);      ///< kg

    /// As given.
    void start(std::span<const Real> inverse_masses);
    /// After a solve that found the pressures λ, [T], at `geometry`.
    void find_tension(const Topology& topology, std::span<const TriangleGeometry<Real>> geometry,
                      std::span<const Real> lambda);
    /// The share of its displacement that a vertex takes, since the tension was not known to the solve: less than 1
    /// where the vertex weighs less than the tension's stiffness.
    Real share_taken(std::size_t vertex, Real inverse_mass) const;
    /// The masses of the next sub-step.
    void raise(std::span<const Real> inverse_masses);
};

}  // namespace apsl::reference
