// SPDX-License-Identifier: MIT
#pragma once

#include "reference/conjugate_gradient.hpp"
#include "reference/geometry.hpp"
#include "reference/matrix.hpp"

#include "../../kernels/constants.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace apsl::reference {

template <class Real>
using Vector2 = Eigen::Matrix<Real, 2, 1>;

/// A triangle at rest, in its own plane with the first edge along x: the gradients b_k of its three shape functions,
/// 1/m. The deformation gradient is F = Σ_k x_k b_kᵀ (3×2), and b_0 + b_1 + b_2 = 0. All zero where the triangle has no
/// area.
template <class Real>
using RestShape = std::array<Vector2<Real>, 3>;

template <class Real>
RestShape<Real> rest_shape(const Triangle& triangle, std::span<const Real> rest_positions);

/// Of a triangle in Buffers::rest_shapes, [4T].
template <class Real>
RestShape<Real> rest_shape(std::span<const Real> rest_shapes, std::size_t triangle);

/// The greatest singular value of F and its directions: F `material` = `value` · `spatial`. Where both singular values
/// are alike, the direction is that of the rest shape's x.
template <class Real>
struct PrincipalStretch {
    Real value;              ///< s₁, 1 at rest
    Vector2<Real> material;  ///< v₁, in the rest shape's plane, of length 1
    Vector3<Real> spatial;   ///< u₁, of length 1; zero where s₁ is
};

template <class Real>
PrincipalStretch<Real> principal_stretch(const RestShape<Real>& shape, const Triangle& triangle,
                                         std::span<const Real> positions);

/// One linearised condition on a triangle: its value C and ∂C/∂x of each corner.
template <class Real>
struct ConstraintRow {
    Real value;
    std::array<Vector3<Real>, 3> gradients;
};

/// C = A − A⁰, m²; ∂C/∂x_k = ½ g_k.
template <class Real>
ConstraintRow<Real> area_row(const TriangleGeometry<Real>& geometry, Real rest_area);

/// C = A⁰ (s₁ − ceiling), m², which is to end at or below 0; ∂C/∂x_k = A⁰ (v₁·b_k) u₁. s₁ is convex in F, and v₁ may
/// turn freely: shear within the ceiling meets no resistance.
template <class Real>
ConstraintRow<Real> stretch_row(const RestShape<Real>& shape, const Triangle& triangle, std::span<const Real> positions,
                                Real rest_area, Real ceiling);

/// r = ⟨∇row, ∇other⟩ / ⟨∇other, ∇other⟩ in the metric of the corners' inverse masses: how much of `other` is in `row`.
/// 0 where `other` moves nothing.
template <class Real>
Real share_of_other(const ConstraintRow<Real>& row, const ConstraintRow<Real>& other,
                    const std::array<Real, 3>& inverse_masses);

/// ⟨∇a, ∇b⟩ in the metric of the corners' inverse masses.
template <class Real>
Real weighted_product(const ConstraintRow<Real>& a, const ConstraintRow<Real>& b,
                      const std::array<Real, 3>& inverse_masses);

/// `row` less r times `other`, r as in share_of_other: what `row` demands beyond `other`. Solving with the pair (other,
/// the result) in place of (other, row) gives the same displacements and the same multiplier of `row`. `row` itself
/// where `other` moves nothing.
template <class Real>
ConstraintRow<Real> orthogonalized(const ConstraintRow<Real>& row, const ConstraintRow<Real>& other,
                                   const std::array<Real, 3>& inverse_masses);

/// Of Σ |∇C_k|² the share of corners that can move.
template <class Real>
Real movable_share(const ConstraintRow<Real>& row, const std::array<Real, 3>& inverse_masses);

/// What an orthogonalized row is asked for of the `value` that it demands, where of its |∇C|² `size` this much is
/// `left`, or to corners that can move: all of it, or, of a weak row, less. Where next to nothing is left no motion
/// brings the triangle below its ceiling and keeps its area, and the one that is asked for goes far, to the side.
template <class Real>
Real asked_of_row(Real value, Real left, Real size) {
    const Real share = std::min(left / (Real(APSLK_WEAK_ROW_SHARE) * size), Real(1));
    return std::min(value, share * share * value);
}

/// Likewise an area row of its `value`, where one corner is pinned or more. Pins that come near to one another leave
/// the other corner a short edge: it would have to go far to mend the area.
template <class Real>
Real asked_of_area_row(const ConstraintRow<Real>& row, Real rest_area, const std::array<Real, 3>& inverse_masses);

/// Conditions J Δx = −b on the coordinates of all vertices. A row is divided by √D, D = Σ_k w_k |∇C_k|², so that
/// J W Jᵀ has ones on its diagonal; a row with D = 0 is zero. With J W Jᵀ y = b the displacement is Δx = −W Jᵀ y and
/// the multiplier of the row itself y / √D.
template <class Real>
struct RowSystem {
    SparseMatrix<Real> J;        ///< [R, 3V]
    TriangleVector<Real> b;      ///< [R]
    TriangleVector<Real> scale;  ///< √D, [R]
};

/// `rows` [R] on the triangles `owners` [R].
template <class Real>
RowSystem<Real> row_system(const Topology& topology, std::span<const ConstraintRow<Real>> rows,
                           std::span<const std::uint32_t> owners, std::span<const Real> inverse_masses);

/// J W Jᵀ, [R, R].
template <class Real>
SparseMatrix<Real> row_matrix(const RowSystem<Real>& system, std::span<const Real> inverse_masses);

/// B, [R], with J W Jᵀ ≼ diag(B): J W Jᵀ is a sum over vertices of w_i J_i J_iᵀ, J_i the columns of vertex i, so B_r is
/// the sum over the row's corners of w_i |g|², g its gradient there, times the greatest eigenvalue of Σ ĝ ĝᵀ, ĝ =
/// g/|g|, over the rows at the corner (as in vertex_bounds).
template <class Real>
TriangleVector<Real> row_bound(const RowSystem<Real>& system, std::span<const Real> inverse_masses);

}  // namespace apsl::reference
