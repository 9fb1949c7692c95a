// SPDX-License-Identifier: MIT
#pragma once

#include "reference/geometry.hpp"

#include <apsl/topology.hpp>

#include <array>
#include <span>

// The bending of two triangles at their common edge (docs/formulation.md, Bending).
namespace apsl::reference {

/// A hinge (e0, e1, o0, o1) at the given positions.
template <class Real>
struct HingeGeometry {
    /// rad, in (−π, π]: θ from the normal of (e0, e1, o0) to that of (e1, e0, o1), about the edge from e0 to e1; 0
    /// where flat. The sign is that of the order of the hinge's vertices, whatever way its triangles are turned.
    Real angle;
    std::array<Vector3<Real>, 4> gradients;  ///< ∂θ/∂x of the vertices in their order, 1/m
};

/// Angle and gradients of a hinge; all zero where one of its triangles has no area or the edge no length: θ has no
/// value there.
template <class Real>
HingeGeometry<Real> hinge_geometry(const Hinge& hinge, std::span<const Real> positions);

/// A hinge at rest.
template <class Real>
struct RestHinge {
    Real angle;  ///< θ⁰, rad
    Real shape;  ///< l²/(A₀ + A₁), edge and triangles at rest; 0 where these have no area: the hinge bends freely
};

template <class Real>
RestHinge<Real> rest_hinge(const Hinge& hinge, std::span<const Real> rest_positions);

/// θ − θ⁰ by the shorter way round, rad, in [−π, π]: a fold that passes through π goes on.
template <class Real>
Real bend(Real angle, Real rest_angle);

/// ½ B l²/(A₀ + A₁) (θ − θ⁰)², J, of a sheet of rigidity B, N·m.
template <class Real>
Real hinge_energy(const RestHinge<Real>& rest, Real rigidity, Real angle);

}  // namespace apsl::reference
