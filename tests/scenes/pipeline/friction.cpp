// SPDX-License-Identifier: MIT
#include "pipeline/advance.hpp"
#include "pipeline/colliders.hpp"
#include "pipeline/implicit_springs.hpp"
#include "sample_cloth.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace apsl;
using namespace apsl::scenes;

namespace {

constexpr double time_step = 1.0 / 60.0;

// A sheet that lies on the floor y = 0, no springs.
ClothState sheet_on_floor() {
    return sample_cloth(test::grid(3, 3, 0.2, 0.2, test::Diagonals::uniform));
}

void advance(ClothState& cloth, const Collider& collider, const std::array<double, 3>& gravity, int steps) {
    ImplicitSprings free_fall(cloth, {}, 0.0);
    for (int step = 0; step < steps; ++step) {
        free_fall.advance_velocities(cloth, gravity, time_step);
        resolve_collisions(cloth, std::array{ColliderStep{collider}}, time_step);
        advance_positions(cloth, time_step);
    }
}

}  // namespace

TEST_CASE("friction: what slides on a floor slows down by μ g") {
    const double friction = GENERATE(0.1, 0.3);
    ClothState cloth = sheet_on_floor();
    for (std::size_t vertex = 0; vertex < 9; ++vertex) {
        cloth.velocities[3 * vertex] = 3.0;
        cloth.velocities[3 * vertex + 2] = 4.0;
    }
    const Collider floor = Plane{.point = {}, .normal = {0, 1, 0}, .contact = {.friction = friction}};
    advance(cloth, floor, {0.0, -9.81, 0.0}, 60);
    const double speed = 5.0 - friction * 9.81;
    for (std::size_t vertex = 0; vertex < 9; ++vertex) {
        CHECK(cloth.velocities[3 * vertex] == Approx(0.6 * speed).epsilon(1e-9));
        CHECK(cloth.velocities[3 * vertex + 2] == Approx(0.8 * speed).epsilon(1e-9));
        CHECK(cloth.positions[3 * vertex + 1] == Approx(0.0).margin(1e-9));
    }
}

TEST_CASE("friction: on a slope it sticks inside the cone of friction and slides outside it") {
    const double slope = std::numbers::pi / 6.0;  // tan = 0.577
    const std::array<double, 3> gravity{9.81 * std::sin(slope), -9.81 * std::cos(slope), 0.0};
    const auto slid = [&](double friction) {
        ClothState cloth = sheet_on_floor();
        advance(cloth, Plane{.point = {}, .normal = {0, 1, 0}, .contact = {.friction = friction}}, gravity, 60);
        return cloth.velocities[0];
    };
    CHECK(std::abs(slid(0.6)) < 1e-9);
    CHECK(slid(0.5) == Approx(9.81 * (std::sin(slope) - 0.5 * std::cos(slope))).epsilon(1e-9));
    CHECK(slid(0.0) == Approx(9.81 * std::sin(slope)).epsilon(1e-9));
}

TEST_CASE("friction: what sticks stops dead and is not turned round") {
    ClothState cloth = sheet_on_floor();
    for (std::size_t vertex = 0; vertex < 9; ++vertex) cloth.velocities[3 * vertex] = 0.1;
    advance(cloth, Plane{.point = {}, .normal = {0, 1, 0}, .contact = {.friction = 10.0}}, {0.0, -9.81, 0.0}, 1);
    for (std::size_t vertex = 0; vertex < 9; ++vertex) CHECK(cloth.velocities[3 * vertex] == Approx(0.0).margin(1e-15));
}
