// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

namespace apsl {

/// What the bound of the matrix is multiplied by: it is that of a sub-step before, and the cloth goes on moving.
inline constexpr float bound_margin = 1.1f;
/// The bound, over D, of a triangle that had no extent when bounds were made, which may get any: several times that of
/// a triangle in a flat mesh, so that it is held back until there is a bound for it.
inline constexpr float unknown_bound = 16.0f;

/// Products with the matrix in a Chebyshev solve, whose polynomial has one degree more: at least 1, at most `most`.
///
/// A smooth error λ (in units of diag G) shrinks in a solve by 1 − λ/(α − 1) with damping, and by 1 − 1.07 d² λ/3 with
/// a polynomial of degree d, the matrix being scaled by its bound, some three times diag G on a flat mesh: equal at
/// d = √(2.8/(α − 1)).
inline int chebyshev_products(double alpha, int most) {
    const double degree = std::sqrt(2.8 / (alpha - 1.0));
    return static_cast<int>(std::clamp(std::round(degree) - 1.0, 1.0, std::max(1.0, static_cast<double>(most))));
}

}  // namespace apsl
