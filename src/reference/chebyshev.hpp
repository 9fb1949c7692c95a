// SPDX-License-Identifier: MIT
#pragma once

#include "reference/conjugate_gradient.hpp"
#include "reference/geometry.hpp"
#include "reference/matrix.hpp"

#include <span>
#include <vector>

namespace apsl::reference {

/// B, [T], with G ≼ diag(B) for the consistent matrix G: no eigenvalue of diag(B)^(−1/2) G diag(B)^(−1/2) is above 1.
///
/// G is a sum over vertices of ½ w_i J_i J_iᵀ, the rows of J_i being the g_{a,i} of the triangles around i: no greater
/// there than its greatest eigenvalue σ_i, which is that of the 3×3 matrix ½ w_i Σ_{a∋i} g gᵀ, and nothing elsewhere.
/// So B_a = Σ_{i∈a} σ_i. Taken for σ_i is the 32nd root of the sum of the eigenvalues' 32nd powers, up to 1.04 times as
/// much.
template <class Real>
void diagonal_bound(const Topology& topology, std::span<const TriangleGeometry<Real>> geometry,
                    std::span<const Real> inverse_masses, TriangleVector<Real>& bound);

/// The vectors that a Chebyshev solve needs; kept from one solve to the next.
template <class Real>
struct ChebyshevScratch {
    TriangleVector<Real> inverse_bound, residual, step, product;
};

/// λ = q(B⁻¹G) B⁻¹b with 1 − x q(x) the Chebyshev polynomial of degree `products` + 1 that is 1 at x = 0 and within
/// ±1/3 on as much of [0, 1] as can be, up to 1 (Saad 2003, Iterative Methods for Sparse Linear Systems,
/// Algorithm 12.1). Rows of B = 0 stay at 0.
template <class Real>
void chebyshev(const SparseMatrix<Real>& G, const TriangleVector<Real>& bound, const TriangleVector<Real>& b,
               int products, ChebyshevScratch<Real>& scratch, TriangleVector<Real>& lambda);

}  // namespace apsl::reference
