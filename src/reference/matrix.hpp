// SPDX-License-Identifier: MIT
#pragma once

#include "reference/geometry.hpp"

#include <apsl/topology.hpp>

#include <Eigen/SparseCore>
#include <cstdint>
#include <span>

namespace apsl::reference {

/// Rows and columns are triangles.
template <class Real>
using SparseMatrix = Eigen::SparseMatrix<Real, Eigen::RowMajor>;

/// A matrix of zeros with the pattern's structure, [T, T]; the structure then stays and values are filled in again and
/// again. Throws Error(invalid_mesh) beyond 2³¹ − 1 entries, Eigen's limit.
template <class Real>
SparseMatrix<Real> zero_matrix(const CsrPattern& pattern);

/// Fills in G of the update (6), so that to first order the area changes are −G λ:
///     G_ac = ½ Σ_{i ∈ a∩c} w_i g_{a,i}·g_{c,i}        (1/kg · m²)
/// Symmetric positive semi-definite for any masses, pins and shape; its diagonal is Eq. (3).
/// G has the pattern of Matrix::consistent and `shared` is CsrPattern::shared of it; geometry [T], inverse_masses [V].
template <class Real>
void consistent_matrix(const Topology& topology, std::span<const std::uint8_t> shared,
                       std::span<const TriangleGeometry<Real>> geometry, std::span<const Real> inverse_masses,
                       SparseMatrix<Real>& G);

/// Fills in G of Eqs. (3) and (4), triangles across an edge only:
///     G_ac = ½ √(w_i w_m) (n_a·n_c) |e_shared|²       (1/kg · m²)
/// where i of a and m of c are the vertices opposite the shared edge. The paper writes w_i, which is not symmetric; the
/// geometric mean is, stays positive semi-definite, and is the printed formula where the masses are equal.
/// n_a·n_c takes the triangles to be wound alike. G has the pattern of Matrix::printed; else as above.
template <class Real>
void printed_matrix(const Topology& topology, std::span<const std::uint8_t> shared,
                    std::span<const TriangleGeometry<Real>> geometry, std::span<const Real> inverse_masses,
                    SparseMatrix<Real>& G);

/// Pattern and values of either matrix at once, for a single use.
template <class Real>
SparseMatrix<Real> pressure_matrix(Matrix matrix, const Topology& topology,
                                   std::span<const TriangleGeometry<Real>> geometry,
                                   std::span<const Real> inverse_masses);

/// Multiplies the diagonal by α (Section 4): (G + (α − 1) diag G). The diagonal must be in the pattern.
template <class Real>
void regularize(Real alpha, SparseMatrix<Real>& G);
/// The same with one α for each triangle, [T].
template <class Real>
void regularize(std::span<const Real> alpha, SparseMatrix<Real>& G);

}  // namespace apsl::reference
