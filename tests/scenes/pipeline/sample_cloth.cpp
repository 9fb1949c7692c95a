// SPDX-License-Identifier: MIT
#include "sample_cloth.hpp"

#include <cmath>
#include <random>

namespace apsl::scenes {

ClothState sample_cloth(const test::Mesh& mesh, const std::vector<std::uint32_t>& pinned) {
    return make_cloth_state(Topology::build(mesh.triangles, mesh.vertex_count()), mesh.positions, 0.2, pinned);
}

std::vector<double> noise(std::size_t count, double amplitude, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<double> values(count);
    for (double& value : values) value = amplitude * (2.0 * (static_cast<double>(random()) / 4294967296.0) - 1.0);
    return values;
}

double norm(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value * value;
    return std::sqrt(sum);
}

std::vector<double> moved(const std::vector<double>& values, double factor, const std::vector<double>& change) {
    std::vector<double> result = values;
    for (std::size_t i = 0; i < result.size(); ++i) result[i] += factor * change[i];
    return result;
}

std::vector<double> momentum(const ClothState& cloth) {
    std::vector<double> sum(3, 0.0);
    for (std::size_t i = 0; i < cloth.velocities.size(); ++i) sum[i % 3] += cloth.masses[i / 3] * cloth.velocities[i];
    return sum;
}

double kinetic_energy(const ClothState& cloth) {
    double energy = 0.0;
    for (std::size_t i = 0; i < cloth.velocities.size(); ++i)
        energy += 0.5 * cloth.masses[i / 3] * cloth.velocities[i] * cloth.velocities[i];
    return energy;
}

}  // namespace apsl::scenes
