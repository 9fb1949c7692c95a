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
constexpr double degree = std::numbers::pi / 180.0;
using Point = std::array<double, 3>;

Point velocity_at(const ColliderStep& collider, const Point& p) {
    Point velocity = collider.drift;
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t k = 0; k < 3; ++k) velocity[row] += collider.turning[3 * row + k] * p[k];
    return velocity;
}

// A sheet that lies on the floor y = 0, no springs.
ClothState sheet_on_floor() {
    return sample_cloth(test::grid(3, 3, 0.2, 0.2, test::Diagonals::uniform));
}

}  // namespace

TEST_CASE("moving colliders: one at rest is as it was, bit for bit, and has no velocity") {
    const Capsule capsule{.a = {0.1, 0.2, 0.3}, .b = {0.4, 0.5, 0.6}, .radius = 0.1, .contact = {}};
    const Motion later{.path = Rotation{.degrees_per_second = 90.0}, .start = 1.0};
    for (const Motion& motion : {Motion{}, later}) {
        const ColliderStep step = collider_step({capsule, motion}, 0.5, time_step);
        CHECK(std::get<Capsule>(step.shape).a == capsule.a);
        CHECK(std::get<Capsule>(step.shape).b == capsule.b);
        CHECK(step.turning == std::array<double, 9>{});
        CHECK(step.drift == Point{});
    }
}

TEST_CASE("moving colliders: they are where their motion has them, until it stops") {
    const Motion carried{.path = Translation{{1.0, -2.0, 0.0}}, .start = 0.5, .stop = 1.0};
    const Sphere sphere{.center = {0, 1, 0}, .radius = 0.3, .contact = {}};
    const auto center = [&](double time) {
        return std::get<Sphere>(collider_step({sphere, carried}, time - time_step, time_step).shape).center;
    };
    CHECK(center(0.4) == Point{0, 1, 0});
    CHECK(center(0.75)[0] == Approx(0.25));
    CHECK(center(0.75)[1] == Approx(0.5));
    CHECK(center(3.0)[0] == Approx(0.5));
    CHECK(center(3.0)[1] == Approx(0.0).margin(1e-15));
    CHECK(velocity_at(collider_step({sphere, carried}, 0.7, time_step), {5, 5, 5})[1] == Approx(-2.0));
    // A plane about its own point, a capsule about the middle of its axis, where no center is given.
    const Motion turned{.path = Rotation{.axis = {0, 0, 2}, .degrees_per_second = 90.0}};
    const ColliderStep plane = collider_step({Plane{.point = {3, 0, 0}, .normal = {0, 2, 0}, .contact = {}}, turned},
                                             1.0 - time_step, time_step);
    CHECK(std::get<Plane>(plane.shape).point[0] == Approx(3.0));
    CHECK(std::get<Plane>(plane.shape).normal[0] == Approx(-2.0));
    CHECK(std::get<Plane>(plane.shape).normal[1] == Approx(0.0).margin(1e-12));
    const ColliderStep capsule = collider_step(
        {Capsule{.a = {1, 0, 0}, .b = {3, 0, 0}, .radius = 0.1, .contact = {}}, turned}, 1.0 - time_step, time_step);
    CHECK(std::get<Capsule>(capsule.shape).a[0] == Approx(2.0));
    CHECK(std::get<Capsule>(capsule.shape).a[1] == Approx(-1.0));
}

TEST_CASE("moving colliders: the velocity of a turning one is the chord of the step") {
    const Motion turned{.path = Rotation{.axis = {0, 1, 0}, .degrees_per_second = 600.0, .center = Point{1, 0, 2}}};
    const ColliderStep step =
        collider_step({Sphere{.center = {1, 0, 2}, .radius = 0.5, .contact = {}}, turned}, 0.3, time_step);
    const double angle = 600.0 * time_step * degree;  // 10°
    // At the end 0.5 m from the axis along x; at the start it was 10° before.
    const Point velocity = velocity_at(step, {1.5, 0.25, 2.0});
    CHECK(velocity[0] == Approx(0.5 * (1.0 - std::cos(angle)) / time_step));
    CHECK(velocity[1] == Approx(0.0).margin(1e-12));
    CHECK(velocity[2] == Approx(-0.5 * std::sin(angle) / time_step));
}

TEST_CASE("moving colliders: a floor that rises takes the cloth along, and one that slides takes it by friction") {
    ClothState cloth = sheet_on_floor();
    ImplicitSprings free_fall(cloth, {}, 0.0);
    const Plane floor{.point = {}, .normal = {0, 1, 0}, .contact = {.friction = 0.5}};
    const Motion motion{.path = Translation{{2.0, 0.5, 0.0}}};
    for (int step = 0; step < 60; ++step) {
        free_fall.advance_velocities(cloth, {0.0, -9.81, 0.0}, time_step);
        resolve_collisions(cloth, std::array{collider_step({floor, motion}, step * time_step, time_step)}, time_step);
        advance_positions(cloth, time_step);
        for (std::size_t v = 0; v < 9; ++v)
            CHECK(cloth.positions[3 * v + 1] == Approx(0.5 * (step + 1) * time_step).margin(1e-9));
        // Faster by μ g, and by μ times the push that set it going upwards, up to the floor's speed.
        const double expected = 0.5 * (9.81 * (step + 1) * time_step + 0.5);
        if (expected < 2.0) CHECK(cloth.velocities[0] == Approx(expected));
    }
    for (std::size_t v = 0; v < 9; ++v) {
        CHECK(cloth.velocities[3 * v] == Approx(2.0));
        CHECK(cloth.velocities[3 * v + 1] == Approx(0.5));
    }
}

TEST_CASE("moving colliders: a collider that comes to the cloth is the cloth that comes to the collider") {
    const std::array<double, 3> velocity{0.3, 3.0, -0.2};
    const Contact contact{.friction = 0.4, .thickness = 0.01};
    const Collider shape = GENERATE_COPY(
        Collider(Sphere{.center = {0.05, -0.5, 0.0}, .radius = 0.3, .contact = contact}),
        Collider(Plane{.point = {0.0, -0.2, 0.0}, .normal = {0.2, 2.0, 0.1}, .contact = contact}),
        Collider(Capsule{.a = {-0.4, -0.3, 0.1}, .b = {0.5, -0.4, 0.0}, .radius = 0.1, .contact = contact}));
    const auto run = [&](bool collider_moves) {
        ClothState cloth = sample_cloth(test::grid(9, 9, 0.6, 0.6, test::Diagonals::alternating));
        ImplicitSprings integrator(cloth, stretch_springs(*cloth.topology, cloth.rest_positions, 20.0), 0.0);
        if (!collider_moves)
            for (std::size_t n = 0; n < cloth.velocities.size(); ++n) cloth.velocities[n] = -velocity[n % 3];
        const MovingCollider collider{shape, collider_moves ? Motion{.path = Translation{velocity}} : Motion{}};
        for (int step = 0; step < 30; ++step) {
            integrator.advance_velocities(cloth, {}, time_step);
            resolve_collisions(cloth, std::array{collider_step(collider, step * time_step, time_step)}, time_step);
            advance_positions(cloth, time_step);
        }
        return cloth;
    };
    const ClothState moving = run(true), resting = run(false);
    double met = 0.0;
    for (std::size_t n = 0; n < moving.positions.size(); ++n) {
        CHECK(moving.positions[n] - velocity[n % 3] * 30.0 * time_step == Approx(resting.positions[n]).margin(1e-9));
        met = std::max(met, std::abs(moving.positions[n] - moving.rest_positions[n]));
    }
    CHECK(met > 0.1);
}
