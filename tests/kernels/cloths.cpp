// SPDX-License-Identifier: MIT
#include "kernels/cloths.hpp"

#include <apsl/reference.hpp>

#include <cmath>
#include <random>

namespace apsl::test {
namespace {

void round_to_float(std::vector<double>& numbers) {
    for (double& number : numbers) number = static_cast<float>(number);
}

}  // namespace

std::vector<double> random_numbers(std::size_t count, double low, double high, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<double> numbers(count);
    for (double& number : numbers) number = low + (high - low) * static_cast<double>(random()) / 4294967296.0;
    round_to_float(numbers);
    return numbers;
}

Mesh strip(std::uint32_t triangles) {
    Mesh mesh;
    for (std::uint32_t v = 0; v < triangles + 2; ++v)
        mesh.positions.insert(mesh.positions.end(), {0.5 * (v % 64), 0.1 * (v / 64), v % 2 == 0 ? 0.0 : 0.9});
    for (std::uint32_t t = 0; t < triangles; ++t)
        mesh.triangles.push_back(t % 2 == 0 ? Triangle{t, t + 1, t + 2} : Triangle{t + 1, t, t + 2});
    return mesh;
}

Cloth make_cloth(const Mesh& mesh, std::uint32_t seed) {
    Cloth cloth;
    cloth.topology = Topology::build(mesh.triangles, mesh.vertex_count());
    cloth.positions = wavy(mesh.positions, 0.2, seed);
    round_to_float(cloth.positions);
    cloth.velocities = random_numbers(cloth.positions.size(), -3.0, 3.0, seed + 1);
    cloth.inverse_masses = random_numbers(mesh.vertex_count(), 0.5, 20.0, seed + 2);
    for (std::size_t v = 3; v < cloth.inverse_masses.size(); v += 7) cloth.inverse_masses[v] = 0.0;
    cloth.rest_areas = reference::areas<double>(*cloth.topology, cloth.positions);
    const std::vector<double> stretch = random_numbers(cloth.rest_areas.size(), 0.75, 1.3, seed + 3);
    for (std::size_t a = 0; a < stretch.size(); ++a) cloth.rest_areas[a] *= stretch[a];
    round_to_float(cloth.rest_areas);
    cloth.regularization = random_numbers(cloth.rest_areas.size(), 1.0, 3.0, seed + 4);
    std::vector<double> narrower = cloth.positions;
    for (std::size_t n = 0; n < narrower.size(); n += 3) narrower[n] *= 0.9;
    cloth.rest_shapes = reference::rest_shapes<double>(*cloth.topology, narrower);
    round_to_float(cloth.rest_shapes);
    cloth.rest_hinges = random_numbers(2 * cloth.topology->hinge_count(), 0.0, 2.0, seed + 6);
    for (std::size_t n = 0; n < cloth.rest_hinges.size(); n += 4) cloth.rest_hinges[n] = 0.0;
    for (std::size_t n = 1; n < cloth.rest_hinges.size(); n += 12) cloth.rest_hinges[n] = 0.0;
    cloth.stretch_ceilings = random_numbers(cloth.rest_areas.size(), 1.02, 1.2, seed + 5);
    for (std::size_t a = 4; a < cloth.stretch_ceilings.size(); a += 9) cloth.stretch_ceilings[a] = 0.0;
    const std::vector<double> numbers = random_numbers(8 * mesh.vertex_count(), -1.0, 1.0, seed + 6);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
        const double* n = numbers.data() + 8 * v;
        Eigen::Vector3d normal(n[0], n[1], n[2]);
        normal.normalize();
        if (v % 5 == 2) normal.setZero();
        const double offset =
            normal.dot(Eigen::Map<const Eigen::Vector3d>(cloth.positions.data() + 3 * v)) + 0.1 * n[3];
        cloth.contacts.insert(cloth.contacts.end(),
                              {normal.x(), normal.y(), normal.z(), offset, n[4], n[5], n[6], std::abs(n[7])});
    }
    round_to_float(cloth.contacts);
    cloth.accelerations = random_numbers(cloth.positions.size(), -20.0, 20.0, seed + 7);
    return cloth;
}

ScaledSolve scaled_solve(const Cloth& cloth, Matrix matrix, const std::vector<double>& alpha) {
    ScaledSolve solve;
    reference::triangle_geometries<double>(*cloth.topology, cloth.positions, solve.geometry);
    solve.rows = reference::pressure_matrix<double>(matrix, *cloth.topology, solve.geometry, cloth.inverse_masses);
    reference::regularize(std::span<const double>(alpha), solve.rows);
    for (Eigen::Index a = 0; a < solve.rows.rows(); ++a) {
        const double d = solve.rows.coeff(a, a);
        solve.scaled_diagonal.push_back(d);
        solve.scale.push_back(d > 0.0 ? 1.0 / std::sqrt(d) : 0.0);
        std::array<Eigen::Vector3d, 3>& gradients = solve.scaled_gradients.emplace_back();
        for (std::size_t k = 0; k < 3; ++k)
            gradients[k] = solve.scale[a] * std::sqrt(cloth.inverse_masses[cloth.topology->triangles()[a][k]] / 2.0) *
                           solve.geometry[a].gradients[k];
        solve.right_hand_side.push_back(solve.scale[a] * (solve.geometry[a].area - cloth.rest_areas[a]));
    }
    const Eigen::Map<const Eigen::VectorXd> s(solve.scale.data(), solve.rows.rows());
    solve.rows = s.asDiagonal() * solve.rows * s.asDiagonal();
    return solve;
}

std::vector<Cloth> every_kind_of_mesh() {
    return {make_cloth(grid(9, 11, 1.0, 1.0, Diagonals::alternating), 1),
            make_cloth(grid(6, 5, 1.0, 2.0, Diagonals::random), 2),
            make_cloth(tetrahedron(), 3),
            make_cloth(book(4), 4),
            make_cloth(fan(12), 5),
            make_cloth(right_triangle(), 6)};
}

}  // namespace apsl::test
