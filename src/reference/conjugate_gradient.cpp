// SPDX-License-Identifier: MIT
#include "reference/conjugate_gradient.hpp"

#include "finite.hpp"

#include <cmath>
#include <limits>

namespace apsl::reference {
namespace {

/// Scales the guess in `lambda` and leaves b − A λ in `r`.
template <class Real>
void start_from_guess(const SparseMatrix<Real>& A, const TriangleVector<Real>& b, TriangleVector<Real>& product,
                      TriangleVector<Real>& r, TriangleVector<Real>& lambda) {
    product.noalias() = A * lambda;
    const Real curvature = lambda.dot(product);
    const Real scale = b.dot(lambda) / curvature;
    if (curvature > Real(0) && is_finite(scale)) {
        lambda *= scale;
        r = b - scale * product;
    } else {
        lambda.setZero(b.size());
        r = b;
    }
}

}  // namespace

template <class Real>
SolveResult<Real> conjugate_gradient(const SparseMatrix<Real>& A, const TriangleVector<Real>& b, Real tolerance,
                                     int max_iterations, ConjugateGradientScratch<Real>& scratch,
                                     TriangleVector<Real>& lambda, bool guessed) {
    constexpr Real not_a_number = std::numeric_limits<Real>::quiet_NaN();
    auto& [inverse_diagonal, r, z, p, q] = scratch;

    inverse_diagonal = A.diagonal().cwiseInverse();
    // Also where 1/D overflows.
    for (Real& inverse : inverse_diagonal)
        if (!is_finite(inverse)) inverse = Real(0);

    if (guessed) {
        start_from_guess(A, b, q, r, lambda);
    } else {
        lambda.setZero(b.size());
        r = b;
    }
    z = inverse_diagonal.cwiseProduct(r);
    p = z;
    Real rz = r.dot(z);
    if (!is_finite(rz)) return {0, not_a_number, false};
    // A row without a diagonal cannot be reduced and has no say in when to stop.
    const auto norm = [&inverse_diagonal](const TriangleVector<Real>& v) {
        return std::sqrt((inverse_diagonal.array() > Real(0)).select(v.array().square(), Real(0)).sum());
    };
    const Real norm_b = norm(b);
    if (norm_b == Real(0)) return {0, Real(0), true};

    SolveResult<Real> result{0, norm(r) / norm_b, false};
    if (result.relative_residual <= tolerance) return {0, result.relative_residual, true};
    Real pDp = rz;
    while (result.iterations < max_iterations && rz > Real(0)) {  // 0 where squares of what is left underflow
        q.noalias() = A * p;
        const Real pq = p.dot(q);
        if (!is_finite(pq)) return {result.iterations, not_a_number, false};
        if (pq <= std::numeric_limits<Real>::epsilon() * pDp) break;

        const Real step = rz / pq;
        lambda += step * p;
        r -= step * q;
        z = inverse_diagonal.cwiseProduct(r);
        const Real next_rz = r.dot(z);
        ++result.iterations;
        if (!is_finite(next_rz)) return {result.iterations, not_a_number, false};
        const Real norm_r = norm(r);
        result.relative_residual = norm_r / norm_b;
        if (norm_r <= tolerance * norm_b) {
            result.converged = true;
            break;
        }
        const Real beta = next_rz / rz;
        p = z + beta * p;
        pDp = next_rz + beta * beta * pDp;  // zᵀDz = rᵀz, and zᵀDp = rᵀp = 0
        rz = next_rz;
    }
    return result;
}

template SolveResult<double> conjugate_gradient(const SparseMatrix<double>&, const TriangleVector<double>&, double, int,
                                                ConjugateGradientScratch<double>&, TriangleVector<double>&, bool);
template SolveResult<float> conjugate_gradient(const SparseMatrix<float>&, const TriangleVector<float>&, float, int,
                                               ConjugateGradientScratch<float>&, TriangleVector<float>&, bool);

}  // namespace apsl::reference
