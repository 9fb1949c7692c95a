// SPDX-License-Identifier: MIT
#pragma once

#include "reference/matrix.hpp"

#include <Eigen/Core>

namespace apsl::reference {

/// One number for each triangle, [T].
template <class Real>
using TriangleVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// What the iteration works on, kept between solves so that nothing is allocated twice.
template <class Real>
struct ConjugateGradientScratch {
    TriangleVector<Real> inverse_diagonal, residual, preconditioned, direction, product;
};

/// How a solve ended.
template <class Real>
struct SolveResult {
    int iterations;
    Real relative_residual;  ///< ‖r‖ / ‖b‖, rows without a diagonal left out; NaN where a number on the way was not
                             ///< finite
    bool converged;
};

/// Solves A λ = b by Conjugate Gradient, from λ = 0 or, where `guessed`, from t times the λ that comes in, with the
/// Jacobi preconditioner D = diag A = α diag G.
///
/// Stops when ‖r‖ ≤ tolerance · ‖b‖ (Euclidean, areas in m²); after max_iterations; or where the direction is null to
/// rounding (pᵀAp ≤ ε pᵀDp), which α = 1 can bring about: λ then is the last one. Rows with D = 0 (three pinned
/// vertices, no area) have no part in the norms, and λ = 0 there.
/// t = bᵀλ / λᵀAλ brings the guess nearest to the solution in the norm of A; 0 where that is no finite number, or the
/// denominator not positive. So no guess is worse than none.
template <class Real>
SolveResult<Real> conjugate_gradient(const SparseMatrix<Real>& A, const TriangleVector<Real>& b, Real tolerance,
                                     int max_iterations, ConjugateGradientScratch<Real>& scratch,
                                     TriangleVector<Real>& lambda, bool guessed = false);

}  // namespace apsl::reference
