// SPDX-License-Identifier: MIT
#include "run/bending_iterations.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace apsl::scenes {

int bending_iterations(const ClothState& cloth, const Parameters& parameters) {
    const double area = std::accumulate(cloth.rest_areas.begin(), cloth.rest_areas.end(), 0.0);
    const double density = std::accumulate(cloth.masses.begin(), cloth.masses.end(), 0.0) / area;
    // Two triangles fill a square of this side.
    const double squared_edge = 2.0 * area / static_cast<double>(cloth.rest_areas.size());
    const double duration = static_cast<double>(parameters.time_step) / std::max(parameters.sub_steps - 1, 1);
    // Parameters::bending_iterations has the rule.
    const double stiffness =
        static_cast<double>(parameters.bending) * duration * duration / (density * squared_edge * squared_edge);
    return static_cast<int>(std::clamp(std::ceil(std::sqrt(stiffness / 0.0125)), 1.0, 32.0));
}

}  // namespace apsl::scenes
