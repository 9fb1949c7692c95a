// SPDX-License-Identifier: MIT
#include "pipeline/spring_operator.hpp"

#include "sample_cloth.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include <algorithm>

using namespace apsl;
using namespace apsl::scenes;

namespace {

constexpr double time_step = 1.0 / 60.0;
constexpr double damping = 0.5;

std::vector<Spring> all_springs(const ClothState& cloth, double stretch, double bend) {
    std::vector<Spring> springs = stretch_springs(*cloth.topology, cloth.rest_positions, stretch);
    const std::vector<Spring> bending = bending_springs(*cloth.topology, cloth.rest_positions, bend);
    springs.insert(springs.end(), bending.begin(), bending.end());
    return springs;
}

// A sheet drawn out in its plane and lifted, so that every spring is longer than at rest.
ClothState drawn_out_cloth(const std::vector<std::uint32_t>& pinned = {}) {
    const test::Mesh mesh = test::grid(5, 4, 0.4, 0.3, test::Diagonals::random);
    ClothState cloth = sample_cloth(mesh, pinned);
    cloth.positions = moved(test::wavy(mesh.positions, 0.02), 0.5, mesh.positions);
    return cloth;
}

}  // namespace

TEST_CASE("springs: the force is minus the gradient of the energy, by central differences") {
    const test::Mesh mesh = test::grid(5, 4, 0.4, 0.3, test::Diagonals::alternating);
    ClothState cloth = sample_cloth(mesh);
    cloth.positions = test::wavy(mesh.positions, 0.03);  // some longer, some shorter than at rest
    const SpringOperator system(cloth, all_springs(cloth, 20.0, 3.0));
    std::vector<double> forces(cloth.positions.size());
    system.spring_forces(cloth, forces);
    const double step = 1e-6;
    for (std::size_t i = 0; i < forces.size(); ++i) {
        std::vector<double> ahead = cloth.positions;
        std::vector<double> behind = cloth.positions;
        ahead[i] += step;
        behind[i] -= step;
        const double slope =
            (spring_energy(system.springs(), ahead) - spring_energy(system.springs(), behind)) / (2.0 * step);
        CHECK(forces[i] == Approx(-slope).margin(1e-7 * norm(forces)));
    }
    CHECK(norm(forces) > 0.1);
}

TEST_CASE("springs: K times a vector is the change of force along it where no spring is compressed") {
    ClothState cloth = drawn_out_cloth();
    SpringOperator system(cloth, all_springs(cloth, 20.0, 3.0));
    system.linearize(cloth, 1.0, 0.0);
    const std::size_t size = cloth.positions.size();
    for (const Spring& spring : system.springs())
        REQUIRE(make_spring(spring.a, spring.b, cloth.positions, 1.0).rest_length > spring.rest_length);
    const std::vector<double> direction = noise(size, 1.0, 7);
    const double step = 1e-6;
    std::vector<double> ahead(size), behind(size), product(size, 0.0);
    ClothState probe = cloth;
    probe.positions = moved(cloth.positions, step, direction);
    system.spring_forces(probe, ahead);
    probe.positions = moved(cloth.positions, -step, direction);
    system.spring_forces(probe, behind);
    std::vector<double> difference = moved(ahead, -1.0, behind);
    for (double& value : difference) value /= 2.0 * step;
    system.add_stiffness(direction, product);
    CHECK(norm(moved(product, -1.0, difference)) < 1e-7 * norm(difference));
}

TEST_CASE("springs: the system is symmetric positive definite on free vertices, compressed springs included") {
    const test::Mesh mesh = test::grid(4, 4, 0.3, 0.3, test::Diagonals::uniform);
    ClothState cloth = sample_cloth(mesh, {0, 5});
    cloth.positions = moved(test::wavy(mesh.positions, 0.02), -0.6, mesh.positions);  // squeezed
    SpringOperator system(cloth, all_springs(cloth, 2000.0, 300.0));
    system.linearize(cloth, time_step, damping);
    const auto size = static_cast<Eigen::Index>(cloth.positions.size());
    Eigen::MatrixXd matrix(size, size);
    for (Eigen::Index column = 0; column < size; ++column) {
        std::vector<double> unit(cloth.positions.size(), 0.0), image(cloth.positions.size());
        const bool pinned = cloth.inverse_masses[static_cast<std::size_t>(column) / 3] == 0.0;
        unit[static_cast<std::size_t>(column)] = pinned ? 0.0 : 1.0;
        system.apply(unit, image);
        matrix.col(column) = Eigen::Map<Eigen::VectorXd>(image.data(), size);
        if (pinned) matrix(column, column) = 1.0;
    }
    CHECK((matrix - matrix.transpose()).norm() <= 1e-14 * matrix.norm());
    const double lightest = *std::min_element(cloth.masses.begin(), cloth.masses.end()) * (1.0 + time_step * damping);
    CHECK(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues().minCoeff() >= 0.999 * lightest);
}

TEST_CASE("springs: the preconditioner inverts the blocks on the diagonal and nothing reaches pinned vertices") {
    ClothState cloth = drawn_out_cloth({3});
    SpringOperator system(cloth, all_springs(cloth, 20.0, 3.0));
    system.linearize(cloth, time_step, damping);
    const std::size_t size = cloth.positions.size();
    for (std::size_t vertex = 0; vertex < size / 3; ++vertex) {
        std::vector<double> vector(size, 0.0), image(size), back(size);
        const std::vector<double> local = noise(3, 1.0, static_cast<std::uint32_t>(vertex));
        if (vertex != 3)
            std::copy(local.begin(), local.end(), vector.begin() + static_cast<std::ptrdiff_t>(3 * vertex));
        system.apply(vector, image);
        system.precondition(image, back);
        for (std::size_t i = 3 * vertex; i < 3 * vertex + 3; ++i) CHECK(back[i] == Approx(vector[i]).margin(1e-12));
        CHECK(image[9] * image[9] + image[10] * image[10] + image[11] * image[11] == 0.0);
        CHECK(back[9] * back[9] + back[10] * back[10] + back[11] * back[11] == 0.0);
    }
}
