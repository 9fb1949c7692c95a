// SPDX-License-Identifier: MIT
#include "pipeline/energy.hpp"

#include "pipeline/geometry.hpp"
#include "pipeline/spring_operator.hpp"

#include <algorithm>
#include <cmath>

namespace apsl::scenes {

Energy energy(const ClothState& cloth, std::span<const Spring> springs, const std::array<double, 3>& gravity) {
    Energy sum;
    const Eigen::Vector3d g(gravity[0], gravity[1], gravity[2]);
    for (std::size_t v = 0; v < cloth.masses.size(); ++v) {
        if (cloth.inverse_masses[v] == 0.0) continue;
        const Eigen::Vector3d moved = vector_at(std::span<const double>(cloth.positions), v) -
                                      vector_at(std::span<const double>(cloth.rest_positions), v);
        sum.kinetic += 0.5 * cloth.masses[v] * vector_at(std::span<const double>(cloth.velocities), v).squaredNorm();
        sum.gravity -= cloth.masses[v] * g.dot(moved);
    }
    sum.springs = spring_energy(springs, cloth.positions);
    return sum;
}

double greatest_speed(const ClothState& cloth) {
    double squared = 0.0;
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
        if (cloth.inverse_masses[v] == 0.0) continue;
        squared = std::max(squared, vector_at(std::span<const double>(cloth.velocities), v).squaredNorm());
    }
    return std::sqrt(squared);
}

}  // namespace apsl::scenes
