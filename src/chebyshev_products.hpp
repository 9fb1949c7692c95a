// SPDX-License-Identifier: MIT
#pragma once

#include "../kernels/constants.h"

#include <algorithm>
#include <cmath>

namespace apsl {

inline constexpr float bound_margin = APSLK_BOUND_MARGIN;
inline constexpr float raised_margin = APSLK_RAISED_MARGIN;

/// Products with the matrix in a Chebyshev solve, whose polynomial has one degree more: at least 1, at most `most`.
///
/// A smooth error λ (in units of diag G) shrinks in a solve by 1 − λ/(α − 1) with damping, and by 1 − 1.07 d² λ/3 with
/// a polynomial of degree d, the matrix being scaled by its bound, some three times diag G on a flat mesh: equal at
/// d = √(2.8/(α − 1)). Where triangles have two rows, of area and of stretch, the bound is larger.
inline int chebyshev_products(double alpha, int most, bool limits_stretch = false) {
    const auto reach = static_cast<double>(limits_stretch ? APSLK_ROWS_REACH : APSLK_CHEBYSHEV_REACH);
    const double degree = std::sqrt(reach / (alpha - 1.0));
    return static_cast<int>(std::clamp(std::round(degree) - 1.0, 1.0, std::max(1.0, static_cast<double>(most))));
}

}  // namespace apsl
