// SPDX-License-Identifier: MIT
#pragma once

#include "reference/conjugate_gradient.hpp"

namespace apsl::reference {

/// Solves A λ = b by a sparse LDLᵀ factorisation, to compare Conjugate Gradient with. Rows with a zero diagonal get
/// λ = 0, as there. Throws Error(invalid_argument) where the factorisation meets a zero pivot (α = 1 can).
template <class Real>
TriangleVector<Real> direct_solve(const SparseMatrix<Real>& A, const TriangleVector<Real>& b);

}  // namespace apsl::reference
