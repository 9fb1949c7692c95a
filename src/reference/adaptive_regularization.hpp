// SPDX-License-Identifier: MIT
#pragma once

#include "../../kernels/constants.h"

#include <apsl/parameters.hpp>

#include <algorithm>

namespace apsl::reference {

/// α of the next solve where the factor is ≥ 1 (Section 4: raised where CG fails or takes too many iterations, restored
/// where it takes few); α as given where it is 1. The floor lets α = 1 be raised too.
template <class Real>
Real raised_regularization(Real alpha, Real factor) {
    return alpha + (factor - Real(1)) * std::max(alpha - Real(1), static_cast<Real>(APSLK_LEAST_ADAPTED_DAMPING));
}

/// The factor after a solve that took `iterations`: doubled, halved or kept. Always 1 with adaptive_threshold = 0.
template <class Real>
Real adapted_factor(Real factor, const Parameters& parameters, int iterations, bool converged) {
    if (parameters.adaptive_threshold == 0) return Real(1);
    if (!converged || iterations > parameters.adaptive_threshold)
        return std::min(Real(2) * factor, static_cast<Real>(APSLK_GREATEST_ADAPTIVE_FACTOR));
    return 2 * iterations <= parameters.adaptive_threshold ? std::max(factor / Real(2), Real(1)) : factor;
}

}  // namespace apsl::reference
