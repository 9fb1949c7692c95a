// SPDX-License-Identifier: MIT
#include "compare/measures.hpp"

#include "pipeline/geometry.hpp"

#include <algorithm>
#include <cmath>

namespace apsl::compare {

using scenes::vector_at;

Deviation deviation(std::span<const double> positions, std::span<const double> expected) {
    Deviation result;
    double squares = 0.0;
    const std::size_t vertices = positions.size() / 3;
    for (std::size_t v = 0; v < vertices; ++v) {
        const double square = (vector_at(positions, v) - vector_at(expected, v)).squaredNorm();
        squares += square;
        result.max = std::max(result.max, std::sqrt(square));
    }
    result.rms = std::sqrt(squares / static_cast<double>(vertices));
    return result;
}

std::array<double, 3> mean_displacement(const scenes::ClothState& cloth) {
    std::array<double, 3> sum{};
    std::size_t count = 0;
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
        if (cloth.inverse_masses[v] == 0.0) continue;
        ++count;
        for (std::size_t k = 0; k < 3; ++k) sum[k] += cloth.positions[3 * v + k] - cloth.rest_positions[3 * v + k];
    }
    if (count > 0)
        for (double& component : sum) component /= static_cast<double>(count);
    return sum;
}

}  // namespace apsl::compare
