// SPDX-License-Identifier: MIT
#pragma once

#include "reference/conjugate_gradient.hpp"
#include "reference/geometry.hpp"
#include "reference/matrix.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace apsl::reference {

/// The greatest eigenvalue of a symmetric matrix with none below 0, or up to 1.04 times that: (Σ λ³²)^(1/32).
template <class Real>
Real greatest_eigenvalue(const Eigen::Matrix<Real, 3, 3>& M);

/// s, [V]: how far the corner gradients around a vertex point the same way. With J_i the matrix whose rows are the
/// g_{a,i} of the n triangles around vertex i, J_i J_iᵀ ≼ s_i diag(|g_{a,i}|²); s_i is the greatest eigenvalue of
/// Σ_{a∋i} ĝ ĝᵀ, ĝ = g/|g|, between n/3 and n. A gradient without a direction may get any, and adds 1.
template <class Real>
void vertex_bounds(const Topology& topology, std::span<const TriangleGeometry<Real>> geometry,
                   std::vector<Real>& bounds);

/// B, [T], with G ≼ diag(B) for the consistent matrix G: no eigenvalue of diag(B)^(−1/2) G diag(B)^(−1/2) is above 1.
/// G is a sum over vertices of ½ w_i J_i J_iᵀ, so B_a = Σ_{i∈a} s_i ½ w_i |g_{a,i}|². Masses and edge lengths are those
/// of `geometry` and `inverse_masses`; only directions are those that `vertex_bounds` were made from.
template <class Real>
void diagonal_bound(const Topology& topology, std::span<const TriangleGeometry<Real>> geometry,
                    std::span<const Real> inverse_masses, std::span<const Real> vertex_bounds,
                    TriangleVector<Real>& bound);

/// The vectors that a Chebyshev solve needs; kept from one solve to the next.
template <class Real>
struct ChebyshevScratch {
    TriangleVector<Real> inverse_bound, residual, step, product;
};

/// λ = q(B⁻¹G) B⁻¹b with 1 − x q(x) the Chebyshev polynomial of degree `products` + 1 that is 1 at x = 0 and within
/// ±1/3 on as much of [0, 1] as can be, up to 1 (Saad 2003, Iterative Methods for Sparse Linear Systems,
/// Algorithm 12.1). Rows of B = 0 stay at 0.
///
/// λ never goes below 0 in the rows where `one_sided` [T] is not 0 (empty: in none is it). What is cut off is not in
/// the step either: the residual stays exact, and the row begins anew. With `from_lambda` the polynomial goes on from
/// the λ given, at the price of a product. Repeated so, λ goes to the solution of the complementarity problem λ ≥ 0,
/// Gλ ≥ b, λ (Gλ − b) = 0 in those rows and Gλ = b in the others.
template <class Real>
void chebyshev(const SparseMatrix<Real>& G, const TriangleVector<Real>& bound, const TriangleVector<Real>& b,
               int products, ChebyshevScratch<Real>& scratch, TriangleVector<Real>& lambda,
               std::span<const std::uint8_t> one_sided = {}, bool from_lambda = false);

}  // namespace apsl::reference
