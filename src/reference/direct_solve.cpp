// SPDX-License-Identifier: MIT
#include "reference/direct_solve.hpp"

#include <apsl/error.hpp>

#include <Eigen/SparseCholesky>

namespace apsl::reference {

template <class Real>
TriangleVector<Real> direct_solve(const SparseMatrix<Real>& A, const TriangleVector<Real>& b) {
    Eigen::SparseMatrix<Real> system = A;
    TriangleVector<Real> right_side = b;
    // A zero diagonal in a semi-definite matrix is a zero row and column: 1 · λ = 0 stands in.
    for (Eigen::Index a = 0; a < system.rows(); ++a)
        if (system.coeff(a, a) == Real(0)) {
            system.coeffRef(a, a) = Real(1);
            right_side[a] = Real(0);
        }
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<Real>> factors(system);
    if (factors.info() != Eigen::Success)
        throw Error(ErrorCode::invalid_argument,
                    "the matrix has a zero pivot, expected it positive definite (regularization > 1)");
    return factors.solve(right_side);
}

template TriangleVector<double> direct_solve(const SparseMatrix<double>&, const TriangleVector<double>&);
template TriangleVector<float> direct_solve(const SparseMatrix<float>&, const TriangleVector<float>&);

}  // namespace apsl::reference
