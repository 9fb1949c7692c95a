// SPDX-License-Identifier: MIT
#include "pipeline/implicit_springs.hpp"

#include "pipeline/advance.hpp"
#include "pipeline/spring_operator.hpp"
#include "sample_cloth.hpp"

#include <apsl/error.hpp>
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace apsl;
using namespace apsl::scenes;

namespace {

constexpr double time_step = 1.0 / 60.0;
constexpr std::array<double, 3> gravity{0.0, -9.81, 0.0};
constexpr std::array<double, 3> no_gravity{};

std::vector<Spring> curtain_springs(const ClothState& cloth) {
    std::vector<Spring> springs = stretch_springs(*cloth.topology, cloth.rest_positions, 20.0);
    const std::vector<Spring> bending = bending_springs(*cloth.topology, cloth.rest_positions, 0.01);
    springs.insert(springs.end(), bending.begin(), bending.end());
    return springs;
}

}  // namespace

TEST_CASE("implicit springs: without springs a cloth falls with g t, damped as backward Euler has it") {
    const double damping = GENERATE(0.0, 0.5);
    ClothState cloth = sample_cloth(test::grid(5, 5, 1.0, 1.0, test::Diagonals::uniform));
    ImplicitSprings integrator(cloth, {}, damping);
    double expected = 0.0;
    for (int step = 0; step < 60; ++step) {
        integrator.advance_velocities(cloth, gravity, time_step);
        advance_positions(cloth, time_step);
        expected = (expected - 9.81 * time_step) / (1.0 + damping * time_step);
    }
    for (std::size_t i = 0; i < cloth.velocities.size(); ++i)
        CHECK(cloth.velocities[i] == Approx(i % 3 == 1 ? expected : 0.0).margin(1e-12));
    if (damping == 0.0) CHECK(cloth.velocities[1] == Approx(-9.81).epsilon(1e-12));
}

TEST_CASE("implicit springs: a weight on one spring comes to hang m g / k below its rest length") {
    ClothState cloth = sample_cloth(test::right_triangle(), {0, 2});
    // Vertex 1 (0.2/3 kg) lies 2 m from vertex 0 and starts out straight below it.
    cloth.positions[3] = 0.0;
    cloth.positions[4] = -2.0;
    const double stiffness = 10.0;
    ImplicitSprings integrator(cloth, {make_spring(0, 1, cloth.rest_positions, stiffness)}, 2.0);
    for (int step = 0; step < 2000; ++step) {
        integrator.advance_velocities(cloth, gravity, time_step);
        advance_positions(cloth, time_step);
    }
    CHECK(cloth.positions[4] == Approx(-2.0 - 0.2 / 3.0 * 9.81 / stiffness).epsilon(1e-6));
    CHECK(cloth.positions[3] == Approx(0.0).margin(1e-12));
    CHECK(std::abs(cloth.velocities[4]) < 1e-6);
}

TEST_CASE("implicit springs: the energy of a free, undamped cloth does not grow") {
    const test::Mesh mesh = test::grid(9, 9, 1.0, 1.0, test::Diagonals::random);
    ClothState cloth = sample_cloth(mesh);
    cloth.positions = test::wavy(mesh.positions, 0.05);
    cloth.velocities = noise(cloth.velocities.size(), 0.3, 3);
    const std::vector<Spring> springs = curtain_springs(cloth);
    ImplicitSprings integrator(cloth, springs, 0.0);
    double energy = kinetic_energy(cloth) + spring_energy(springs, cloth.positions);
    const double initial = energy;
    for (int step = 0; step < 300; ++step) {
        integrator.advance_velocities(cloth, no_gravity, time_step);
        advance_positions(cloth, time_step);
        const double next = kinetic_energy(cloth) + spring_energy(springs, cloth.positions);
        CHECK(next <= energy + 1e-4 * initial);
        energy = next;
    }
    CHECK(energy < 0.9 * initial);
}

TEST_CASE("implicit springs: springs do not change momentum") {
    const test::Mesh mesh = test::grid(9, 9, 1.0, 1.0, test::Diagonals::alternating);
    ClothState cloth = sample_cloth(mesh);
    cloth.positions = test::wavy(mesh.positions, 0.05);
    cloth.velocities = noise(cloth.velocities.size(), 0.3, 5);
    const std::vector<double> before = momentum(cloth);
    double scale = 0.0;
    ImplicitSprings integrator(cloth, curtain_springs(cloth), 0.0);
    const int steps = 60;
    for (int step = 0; step < steps; ++step) {
        const std::vector<double> velocities = cloth.velocities;
        integrator.advance_velocities(cloth, no_gravity, time_step);
        ClothState change = cloth;
        change.velocities = moved(cloth.velocities, -1.0, velocities);
        for (std::size_t i = 0; i < velocities.size(); ++i)
            scale += cloth.masses[i / 3] * std::abs(change.velocities[i]);
        advance_positions(cloth, time_step);
    }
    // To the solver's tolerance, 1e-3 of what the springs pass about.
    CHECK(norm(moved(momentum(cloth), -1.0, before)) < 1e-3 * scale);
}

TEST_CASE("implicit springs: a cloth at rest stays at rest, to the last bit") {
    const test::Mesh mesh = test::grid(7, 7, 1.0, 1.0, test::Diagonals::alternating);
    ClothState cloth = sample_cloth(mesh);
    ImplicitSprings integrator(cloth, curtain_springs(cloth), 0.5);
    for (int step = 0; step < 20; ++step) {
        integrator.advance_velocities(cloth, no_gravity, time_step);
        advance_positions(cloth, time_step);
    }
    CHECK(cloth.positions == mesh.positions);
}

TEST_CASE("implicit springs: pinned vertices do not move by one bit, and two runs give the same bytes") {
    const test::Mesh mesh = test::grid(17, 17, 1.0, 1.0, test::Diagonals::alternating);
    std::vector<double> ends[2];
    for (auto& end : ends) {
        ClothState cloth = sample_cloth(mesh, {0, 16});
        ImplicitSprings integrator(cloth, curtain_springs(cloth), 0.5);
        for (int step = 0; step < 200; ++step) {
            CHECK(integrator.advance_velocities(cloth, gravity, time_step).converged);
            advance_positions(cloth, time_step);
        }
        for (const std::size_t vertex : {0, 16})
            for (std::size_t axis = 0; axis < 3; ++axis)
                CHECK(cloth.positions[3 * vertex + axis] == mesh.positions[3 * vertex + axis]);
        CHECK(cloth.positions[3 * 280 + 1] < -0.3);  // the free edge hangs
        end = cloth.positions;
    }
    CHECK(ends[0] == ends[1]);
}

TEST_CASE("implicit springs: springs of no length give no NaN") {
    const test::Mesh mesh = test::right_triangle();
    ClothState cloth = sample_cloth(mesh, {0});
    cloth.positions = std::vector<double>(9, 1.0);  // all springs collapsed to a point
    std::vector<Spring> springs = stretch_springs(*cloth.topology, cloth.rest_positions, 100.0);
    springs.push_back({.a = 0, .b = 2, .rest_length = 0.0, .stiffness = 50.0});
    ImplicitSprings integrator(cloth, springs, 0.0);
    for (int step = 0; step < 50; ++step) {
        CHECK(integrator.advance_velocities(cloth, gravity, time_step).converged);
        advance_positions(cloth, time_step);
    }
    for (const double position : cloth.positions) CHECK(std::isfinite(position));
    CHECK(cloth.positions[4] < 1.0);
}

TEST_CASE("implicit springs: a spring of rest length zero is linear, a step has a closed form") {
    ClothState cloth = sample_cloth(test::right_triangle(), {0, 2});
    const double stiffness = 40.0, mass = cloth.masses[1];
    ImplicitSprings integrator(cloth, {{.a = 0, .b = 1, .rest_length = 0.0, .stiffness = stiffness}}, 0.0);
    integrator.advance_velocities(cloth, no_gravity, time_step);
    const double factor = 1.0 / (mass + time_step * time_step * stiffness);
    CHECK(cloth.velocities[3] == Approx(-factor * time_step * stiffness * 2.0).epsilon(1e-12));
    CHECK(cloth.velocities[4] == 0.0);
}

TEST_CASE("implicit springs: numbers that are not finite leave the velocities alone") {
    ClothState cloth = sample_cloth(test::grid(4, 4, 1.0, 1.0, test::Diagonals::uniform));
    ImplicitSprings integrator(cloth, curtain_springs(cloth), 0.5);
    cloth.positions[7] = std::numeric_limits<double>::infinity();
    CHECK_FALSE(integrator.advance_velocities(cloth, gravity, time_step).converged);
    CHECK(cloth.velocities == std::vector<double>(48, 0.0));
}

TEST_CASE("implicit springs: vertices in no triangle stay where they are") {
    test::Mesh mesh = test::right_triangle();
    mesh.positions.insert(mesh.positions.end(), {7.0, 7.0, 7.0});
    ClothState cloth = sample_cloth(mesh);
    ImplicitSprings integrator(cloth, curtain_springs(cloth), 0.0);
    integrator.advance_velocities(cloth, gravity, time_step);
    CHECK(cloth.velocities[10] == 0.0);
    CHECK(cloth.velocities[1] == Approx(-9.81 * time_step).epsilon(1e-3));  // the solver's tolerance
}

TEST_CASE("implicit springs: what cannot be integrated is an error") {
    ClothState cloth = sample_cloth(test::right_triangle());
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(ImplicitSprings(cloth, {{0, 3, 1.0, 1.0}}, 0.0), Catch::Contains("spring 0"));
    CHECK_THROWS_WITH(ImplicitSprings(cloth, {{1, 1, 1.0, 1.0}}, 0.0), Catch::Contains("twice"));
    CHECK_THROWS_WITH(ImplicitSprings(cloth, {{0, 1, -1.0, 1.0}}, 0.0), Catch::Contains("rest length"));
    CHECK_THROWS_WITH(ImplicitSprings(cloth, {{0, 1, 1.0, not_a_number}}, 0.0), Catch::Contains("stiffness"));
    CHECK_THROWS_WITH(ImplicitSprings(cloth, {}, -1.0), Catch::Contains("damping"));
    ImplicitSprings integrator(cloth, {}, 0.0);
    CHECK_THROWS_WITH(integrator.advance_velocities(cloth, gravity, 0.0), Catch::Contains("time_step"));
}
