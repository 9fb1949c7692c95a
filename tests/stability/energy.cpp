// SPDX-License-Identifier: MIT
#include "stability/energy.hpp"

#include <cmath>

namespace apsl::test {

double kinetic_energy(const scenes::ClothState& cloth) {
    double energy = 0.0;
    for (std::size_t n = 0; n < cloth.velocities.size(); ++n)
        energy += 0.5 * cloth.masses[n / 3] * cloth.velocities[n] * cloth.velocities[n];
    return energy;
}

double potential_energy(const scenes::ClothState& cloth, std::span<const scenes::Spring> springs,
                        const std::array<double, 3>& gravity) {
    const std::vector<double>& x = cloth.positions;
    double energy = 0.0;
    for (std::size_t n = 0; n < x.size(); ++n) energy -= cloth.masses[n / 3] * gravity[n % 3] * x[n];
    for (const scenes::Spring& spring : springs) {
        const std::size_t a = 3 * spring.a;
        const std::size_t b = 3 * spring.b;
        const double excess = std::hypot(x[b] - x[a], x[b + 1] - x[a + 1], x[b + 2] - x[a + 2]) - spring.rest_length;
        energy += 0.5 * spring.stiffness * excess * excess;
    }
    return energy;
}

}  // namespace apsl::test
