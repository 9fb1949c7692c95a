// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

namespace apsl::bench {

/// (G + (α − 1) diag G) λ = b of the consistent matrix at a cloth's present geometry, 32-bit CSR: what peers are given.
struct PressureSystem {
    std::vector<int> row_offsets;    ///< [T + 1]
    std::vector<int> columns;        ///< [entries]
    std::vector<float> values;       ///< [entries], 1/kg · m²
    std::vector<float> area_excess;  ///< b, m², [T]

    int rows() const { return static_cast<int>(area_excess.size()); }
};

/// Does that many Conjugate Gradient iterations from λ = 0; λ in kg, [T].
using Solve = std::function<std::vector<float>(int iterations)>;

}  // namespace apsl::bench
