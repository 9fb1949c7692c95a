// SPDX-License-Identifier: MIT
#pragma once

#include "resolved_parameters.hpp"

#include <cmath>

namespace apsl {

/// α of sub-step k of n (Parameters::first_regularization), of which `alpha` is that of the last: α − 1 times
/// ρ^((n − 1 − k) / (n − 1)), ρ being (α − 1) of the first sub-step over that of the last. A single sub-step is the
/// last one.
template <class Real>
Real scheduled_regularization(Real alpha, const ResolvedParameters& parameters, int sub_step) {
    const int last = parameters.sub_steps - 1;
    if (parameters.first_alpha == parameters.regularization || sub_step >= last) return alpha;
    const Real ratio = (static_cast<Real>(parameters.first_alpha) - Real(1)) /
                       (static_cast<Real>(parameters.regularization) - Real(1));
    const Real part = static_cast<Real>(last - sub_step) / static_cast<Real>(last);
    return Real(1) + (alpha - Real(1)) * std::pow(ratio, part);
}

}  // namespace apsl
