// SPDX-License-Identifier: MIT
#include "pipeline/colliders.hpp"

#include "pipeline/advance.hpp"
#include "pipeline/implicit_springs.hpp"
#include "sample_cloth.hpp"

#include <apsl/error.hpp>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace apsl;
using namespace apsl::scenes;

namespace {

constexpr double time_step = 1.0 / 60.0;
using Point = std::array<double, 3>;

// Written apart from the code under test. m, negative inside.
double distance(const Collider& collider, const Point& p) {
    if (const auto* sphere = std::get_if<Sphere>(&collider)) {
        return std::hypot(p[0] - sphere->center[0], p[1] - sphere->center[1], p[2] - sphere->center[2]) -
               sphere->radius;
    }
    if (const auto* plane = std::get_if<Plane>(&collider)) {
        const auto& n = plane->normal;
        const auto& q = plane->point;
        return ((p[0] - q[0]) * n[0] + (p[1] - q[1]) * n[1] + (p[2] - q[2]) * n[2]) / std::hypot(n[0], n[1], n[2]);
    }
    const auto& capsule = std::get<Capsule>(collider);
    double nearest = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= 2000; ++k) {  // the segment as 2001 points, 1e-3 m apart at most here
        const double t = k / 2000.0;
        double squared = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double offset = p[axis] - ((1.0 - t) * capsule.a[axis] + t * capsule.b[axis]);
            squared += offset * offset;
        }
        nearest = std::min(nearest, std::sqrt(squared));
    }
    return nearest - capsule.radius;
}

Point place(const ClothState& cloth, std::size_t vertex) {
    return {cloth.positions[3 * vertex], cloth.positions[3 * vertex + 1], cloth.positions[3 * vertex + 2]};
}

}  // namespace

TEST_CASE("colliders: a cloth dropped onto each of them never gets inside") {
    const Contact contact{.friction = GENERATE(0.0, 0.4), .thickness = GENERATE(0.0, 0.01)};
    const Collider collider = GENERATE_COPY(
        Collider(Sphere{.center = {0.1, -0.4, 0.0}, .radius = 0.3, .contact = contact}),
        Collider(Plane{.point = {0.0, -0.2, 0.0}, .normal = {0.2, 2.0, 0.1}, .contact = contact}),
        Collider(Capsule{.a = {-0.4, -0.3, 0.1}, .b = {0.5, -0.4, 0.0}, .radius = 0.1, .contact = contact}));
    ClothState cloth = sample_cloth(test::grid(13, 13, 1.0, 1.0, test::Diagonals::alternating));
    ImplicitSprings integrator(cloth, stretch_springs(*cloth.topology, cloth.rest_positions, 20.0), 0.5);
    std::size_t touched = 0;
    double deepest = std::numeric_limits<double>::infinity();
    for (int step = 0; step < 90; ++step) {
        integrator.advance_velocities(cloth, {0.0, -9.81, 0.0}, time_step);
        touched += resolve_collisions(cloth, std::array{ColliderStep{collider}}, time_step);
        advance_positions(cloth, time_step);
        for (std::size_t vertex = 0; vertex < cloth.masses.size(); ++vertex)
            deepest = std::min(deepest, distance(collider, place(cloth, vertex)) - contact.thickness);
    }
    CHECK(touched > 100);
    CHECK(deepest > -1e-9);
    CHECK(deepest < 1e-4);  // and it does touch
}

TEST_CASE("colliders: a corner between two planes and a sphere on the floor hold too") {
    const std::vector<ColliderStep> colliders{
        ColliderStep{Plane{.point = {0, -0.2, 0}, .normal = {0, 1, 0}, .contact = {}}},
        ColliderStep{Plane{.point = {0.3, 0, 0}, .normal = {-1, 1, 0}, .contact = {}}},
        ColliderStep{Sphere{.center = {0, -0.1, 0}, .radius = 0.15, .contact = {}}}};
    ClothState cloth = sample_cloth(test::grid(13, 13, 0.4, 0.4, test::Diagonals::alternating));
    ImplicitSprings integrator(cloth, stretch_springs(*cloth.topology, cloth.rest_positions, 20.0), 0.5);
    for (int step = 0; step < 120; ++step) {
        integrator.advance_velocities(cloth, {2.0, -9.81, 0.0}, time_step);
        resolve_collisions(cloth, colliders, time_step);
        advance_positions(cloth, time_step);
    }
    for (std::size_t vertex = 0; vertex < cloth.masses.size(); ++vertex)
        for (const ColliderStep& collider : colliders) CHECK(distance(collider.shape, place(cloth, vertex)) > -1e-6);
}

TEST_CASE("colliders: a place at the very center or axis is pushed out, not made NaN") {
    const Collider collider = GENERATE(Collider(Sphere{.center = {0, 0, 0}, .radius = 0.5, .contact = {}}),
                                       Collider(Capsule{.a = {0, -1, 0}, .b = {0, 1, 0}, .radius = 0.5, .contact = {}}),
                                       Collider(Capsule{.a = {0, 0, 0}, .b = {0, 0, 0}, .radius = 0.5, .contact = {}}));
    ClothState cloth = sample_cloth(test::right_triangle());  // vertex 0 lies at the origin
    resolve_collisions(cloth, std::array{ColliderStep{collider}}, time_step);
    advance_positions(cloth, time_step);
    CHECK(distance(collider, place(cloth, 0)) == Approx(0.0).margin(1e-9));
}

TEST_CASE("colliders: what is outside and what is pinned keeps its velocity, bit for bit") {
    ClothState cloth = sample_cloth(test::right_triangle(), {0});
    cloth.velocities = noise(9, 0.1, 1);
    const std::vector<double> before = cloth.velocities;
    const std::vector<ColliderStep> colliders{
        ColliderStep{Sphere{.center = {0, 0, 0}, .radius = 0.5, .contact = {.friction = 1.0}}}};
    CHECK(resolve_collisions(cloth, colliders, time_step) == 0);
    CHECK(cloth.velocities == before);
}

TEST_CASE("colliders: what starts inside is led out, and keeps no speed from it") {
    const Contact contact{.friction = GENERATE(0.0, 0.4), .thickness = 0.01};
    const double depth = GENERATE(0.02, 0.19);
    // Vertices at all depths, in a plane that cuts the collider; the last ones start outside.
    const Collider collider = GENERATE_COPY(
        Collider(Sphere{.center = {0.0, depth - 0.19, 0.0}, .radius = 0.18, .contact = contact}),
        Collider(Plane{.point = {0.0, depth - 0.01, 0.0}, .normal = {0.1, 2.0, 0.0}, .contact = contact}),
        Collider(Capsule{
            .a = {0.0, depth - 0.19, -1.0}, .b = {0.0, depth - 0.19, 1.0}, .radius = 0.18, .contact = contact}));
    ClothState cloth = sample_cloth(test::grid(9, 9, 0.5, 0.5, test::Diagonals::alternating), {40});
    const StartInside before = start_inside(cloth, collider);
    CHECK(before.vertices > 0);
    CHECK(before.vertices <= 80);  // the pinned one in the middle is not counted
    const std::vector<double> pinned(cloth.positions.begin() + 120, cloth.positions.begin() + 123);
    double fastest = 0.0;
    double deepest = before.depth;
    for (int step = 0; step < 120; ++step) {
        resolve_collisions(cloth, std::array{ColliderStep{collider}}, time_step, true);
        advance_positions(cloth, time_step);
        for (const double velocity : cloth.velocities) fastest = std::max(fastest, std::abs(velocity));
        const StartInside now = start_inside(cloth, collider);
        CHECK(now.depth <= deepest);
        deepest = now.depth;
    }
    CHECK(deepest == 0.0);
    CHECK(fastest < 1e-4 / time_step);  // no more than of the last part; at once it would be depth / Δt, 11 m/s
    CHECK(std::vector<double>(cloth.positions.begin() + 120, cloth.positions.begin() + 123) == pinned);
}

TEST_CASE("colliders: what starts inside and moves inwards comes no deeper, under gravity too") {
    const Collider floor =
        Plane{.point = {0.0, 0.1, 0.0}, .normal = {0, 1, 0}, .contact = {.friction = 0.3, .thickness = 0.0}};
    ClothState cloth = sample_cloth(test::grid(3, 3, 0.2, 0.2, test::Diagonals::uniform));
    for (std::size_t vertex = 0; vertex < 9; ++vertex) cloth.velocities[3 * vertex + 1] = -5.0;
    ImplicitSprings free_fall(cloth, {}, 0.0);
    double depth = 0.1;
    for (int step = 0; step < 120; ++step) {
        free_fall.advance_velocities(cloth, {0.0, -9.81, 0.0}, time_step);
        resolve_collisions(cloth, std::array{ColliderStep{floor}}, time_step, true);
        advance_positions(cloth, time_step);
        const double now = -distance(floor, place(cloth, 0));
        CHECK(now <= depth);
        CHECK(now > -1e-9);  // and is not thrown
        depth = now;
    }
    CHECK(depth == Approx(0.0).margin(1e-9));
}

TEST_CASE("colliders: leading out changes no bit where nothing starts inside") {
    const std::vector<ColliderStep> colliders{
        ColliderStep{Sphere{.center = {0, -0.31, 0}, .radius = 0.3, .contact = {.friction = 0.3}}},
        ColliderStep{Plane{.point = {0, -0.2, 0}, .normal = {0, 1, 0}, .contact = {}}}};
    const auto dropped = [&](bool lead_out) {
        ClothState cloth = sample_cloth(test::grid(9, 9, 0.5, 0.5, test::Diagonals::alternating));
        ImplicitSprings integrator(cloth, stretch_springs(*cloth.topology, cloth.rest_positions, 20.0), 0.5);
        for (int step = 0; step < 30; ++step) {
            integrator.advance_velocities(cloth, {0.0, -9.81, 0.0}, time_step);
            resolve_collisions(cloth, colliders, time_step, lead_out);
            advance_positions(cloth, time_step);
        }
        return cloth.positions;
    };
    CHECK(dropped(true) == dropped(false));
}

TEST_CASE("colliders: fields out of range are named") {
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(validate(Sphere{.center = {}, .radius = 0.0, .contact = {}}), Catch::Contains("radius"));
    CHECK_THROWS_WITH(validate(Sphere{.center = {0, not_a_number, 0}, .radius = 1.0, .contact = {}}),
                      Catch::Contains("center"));
    CHECK_THROWS_WITH(validate(Plane{.point = {}, .normal = {0, 0, 0}, .contact = {}}), Catch::Contains("normal"));
    CHECK_THROWS_WITH(validate(Capsule{.a = {}, .b = {not_a_number, 0, 0}, .radius = 1.0, .contact = {}}),
                      Catch::Contains("b is not finite"));
    CHECK_THROWS_WITH(validate(Plane{.point = {}, .normal = {0, 1, 0}, .contact = {.friction = -0.1}}),
                      Catch::Contains("friction"));
    CHECK_THROWS_WITH(validate(Plane{.point = {}, .normal = {0, 1, 0}, .contact = {.thickness = not_a_number}}),
                      Catch::Contains("thickness"));
    CHECK_NOTHROW(validate(Capsule{.a = {}, .b = {}, .radius = 1.0, .contact = {}}));
    ClothState cloth = sample_cloth(test::right_triangle());
    CHECK_THROWS_WITH(resolve_collisions(cloth, {}, -1.0), Catch::Contains("time_step"));
}
