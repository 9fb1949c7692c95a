// SPDX-License-Identifier: MIT
#pragma once

#include "unit/reference/sample_cloths.hpp"

#include <apsl/reference.hpp>

#include <vector>

namespace apsl::test {

template <class Real>
struct Filtered {
    std::vector<Real> velocities;
    Stats stats;
};

/// One call of the reference filter. `regularization` per triangle, or empty.
template <class Real>
Filtered<Real> run_filter(const SampleCloth& cloth, const std::vector<double>& velocities, const Parameters& parameters,
                          Matrix matrix = Matrix::consistent, const std::vector<double>& regularization = {}) {
    const auto cast = [](const std::vector<double>& numbers) {
        return std::vector<Real>(numbers.begin(), numbers.end());
    };
    Filtered<Real> result{cast(velocities), {}};
    const auto positions = cast(cloth.positions);
    const auto inverse_masses = cast(cloth.inverse_masses);
    const auto rest_areas = cast(cloth.rest_areas);
    const auto alpha = cast(regularization);
    reference::BasicStrainLimiter<Real> limiter(cloth.topology, {.matrix = matrix});
    limiter.enqueue({positions, result.velocities, inverse_masses, rest_areas, alpha}, parameters);
    result.stats = limiter.read_stats();
    return result;
}

/// Velocities that carry the cloth to `target` (m, [3V]) in one time step.
inline std::vector<double> velocities_towards(const SampleCloth& cloth, const std::vector<double>& target,
                                              double time_step) {
    std::vector<double> velocities(target.size());
    for (std::size_t n = 0; n < target.size(); ++n) velocities[n] = (target[n] - cloth.positions[n]) / time_step;
    return velocities;
}

/// x̃ + Δt ṽ
template <class Real>
std::vector<double> positions_after(const SampleCloth& cloth, const std::vector<Real>& velocities, double time_step) {
    std::vector<double> positions(cloth.positions);
    for (std::size_t n = 0; n < positions.size(); ++n) positions[n] += time_step * static_cast<double>(velocities[n]);
    return positions;
}

}  // namespace apsl::test
