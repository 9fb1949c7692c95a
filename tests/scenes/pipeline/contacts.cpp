// SPDX-License-Identifier: MIT
#include "pipeline/contacts.hpp"

#include "pipeline/geometry.hpp"
#include "sample_cloth.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>

using namespace apsl;
using namespace apsl::scenes;

namespace {

constexpr double time_step = 1.0 / 60.0;
using Vector = Eigen::Vector3d;

struct Record {
    Vector normal;
    double offset;
    Vector velocity;
    double friction;
};

// Of the one vertex at `position` that looks on with `velocity`, by a cloth whose other vertices are pinned.
Record record_of(const Vector& position, const Vector& velocity, std::vector<ColliderStep> colliders,
                 const FreeFlight& flight = {.seconds = time_step}) {
    ClothState cloth = sample_cloth(test::right_triangle(), {1, 2});
    vector_at(std::span(cloth.positions), 0) = position;
    vector_at(std::span(cloth.velocities), 0) = velocity;
    const std::vector<double> records = contacts(cloth, colliders, flight, time_step);
    REQUIRE(records.size() == 24);
    for (std::size_t n = 8; n < 24; ++n) CHECK(records[n] == 0.0);
    return {Vector(records.data()), records[3], Vector(records.data() + 4), records[7]};
}

const Contact contact{.friction = 0.3, .thickness = 0.01};
const Sphere ball{.center = {0, 0, 0}, .radius = 0.29, .contact = contact};  // 0.3 m with its thickness

}  // namespace

TEST_CASE("contacts: free flight is that of gravity and damping") {
    const FreeFlight fall = free_flight({1.0, -9.81, 0.0}, 0.0, 0.1);
    CHECK(fall.seconds == 0.1);
    CHECK(fall.shift[0] == Approx(0.005));
    CHECK(fall.shift[1] == Approx(-0.04905));
    const FreeFlight damped = free_flight({0.0, -9.81, 0.0}, 2.0, 0.1);
    CHECK(damped.seconds == Approx((1.0 - std::exp(-0.2)) / 2.0));
    // The exact one is g (T − s)/d.
    CHECK(damped.shift[1] == Approx(-9.81 * (0.1 - damped.seconds) / 2.0).epsilon(0.05));
}

TEST_CASE("contacts: a floor is its own plane, thickness included, and its velocity") {
    const Plane floor{.point = {5, -1, 0}, .normal = {0, 2, 0}, .contact = contact};
    const Record still = record_of({0, 3, 0}, {0, -1, 0}, {ColliderStep{floor}});
    CHECK(still.normal == Vector(0, 1, 0));
    CHECK(still.offset == Approx(-0.99));
    CHECK(still.velocity == Vector(0, 0, 0));
    CHECK(still.friction == 0.3);
    const ColliderStep rising = collider_step({floor, {.path = Translation{{1, 6, 0}}}}, 0.0, time_step);
    const Record moved = record_of({0, 3, 0}, {0, -1, 0}, {rising});
    CHECK(moved.offset == Approx(-0.89));  // where it is at the end of the step
    CHECK(moved.velocity.isApprox(Vector(1, 6, 0)));
}

TEST_CASE("contacts: without colliders nothing is held off") {
    const Record none = record_of({0, 0, 0}, {0, 0, 0}, {});
    CHECK(none.normal == Vector(0, 0, 0));
    CHECK(none.offset == 0.0);
    CHECK(none.friction == 0.0);
}

TEST_CASE("contacts: the plane touches the ball where free flight comes nearest") {
    // Falls 5 cm into the ball's upper half.
    const Record record = record_of({0.1, 0.32, 0}, {0, -3, 0}, {ColliderStep{ball}});
    const Vector expected = Vector(0.1, 0.27, 0).normalized();
    CHECK(record.normal.isApprox(expected, 1e-12));
    CHECK(record.offset == Approx(0.3));
    // It begins above that plane, which stands still.
    CHECK(record.velocity == Vector(0, 0, 0));
}

TEST_CASE("contacts: the deepest collider wins") {
    const Plane floor{.point = {}, .normal = {0, 1, 0}, .contact = {}};
    const Record on_ball = record_of({0.0, 0.31, 0}, {0, -3, 0}, {ColliderStep{floor}, ColliderStep{ball}});
    CHECK(on_ball.offset == Approx(0.3));
    const Record on_floor = record_of({2.0, 0.02, 0}, {0, -3, 0}, {ColliderStep{floor}, ColliderStep{ball}});
    CHECK(on_floor.normal == Vector(0, 1, 0));
    CHECK(on_floor.offset == 0.0);
}

TEST_CASE("contacts: what would go through a thin rod in one step is held on its near side") {
    const Capsule rod{.a = {-1, 0, 0}, .b = {1, 0, 0}, .radius = 0.02, .contact = {}};
    // From 5 cm above to 15 cm below, and a little off the axis.
    const Record record = record_of({0.0, 0.05, 0.002}, {0, -12, 0}, {ColliderStep{rod}});
    CHECK(record.normal.y() > 0.9);
    CHECK(record.offset == Approx(0.02));
    CHECK(record.normal.x() == Approx(0.0).margin(1e-12));
    // From below too, and where the rod does the moving.
    CHECK(record_of({0.0, -0.05, 0.0}, {0, 12, 0}, {ColliderStep{rod}}).normal.y() == Approx(-1.0));
    const ColliderStep swung = collider_step({rod, {.path = Translation{{0, 12, 0}}}}, 0.0, time_step);
    const Record swept = record_of({0.0, 0.05, 0.0}, {0, 0, 0}, {swung});
    CHECK(swept.normal.y() == Approx(1.0));
    CHECK(swept.offset == Approx(0.22));
    CHECK(swept.velocity.isApprox(Vector(0, 12, 0)));
}

TEST_CASE("contacts: what flies past a ball is not snagged by the plane of its far side") {
    // Past the ball at 5 mm; along a straight way of 0.6 m, in one step.
    const Record record = record_of({-0.3, 0.305, 0}, {36, 0, 0}, {ColliderStep{ball}});
    const Vector begin(-0.3, 0.305, 0), end(0.3, 0.305, 0);
    for (const Vector& place : {begin, Vector(0, 0.305, 0), end})
        CHECK(record.normal.dot(place) - record.offset >= 0.0);
    CHECK(record.velocity.norm() == 0.0);
}

TEST_CASE("contacts: on a curved surface the plane rises from where the vertex is") {
    // Slides on the ball by 5 cm: the tangent where it ends lies above where it begins.
    const Record record = record_of({0, 0.3, 0}, {3, 0, 0}, {ColliderStep{ball}});
    const double start_of_plane = record.offset - time_step * record.normal.dot(record.velocity);
    CHECK(record.normal.dot(Vector(0, 0.3, 0)) == Approx(start_of_plane).epsilon(1e-12));
    CHECK(record.normal.dot(record.velocity) > 0.0);
    // Free flight is away from it: nothing is thrown.
    CHECK(record.normal.dot(Vector(3, 0, 0)) > record.normal.dot(record.velocity));
}

TEST_CASE("contacts: what starts inside is led out by a part of its depth") {
    const Plane floor{.point = {}, .normal = {0, 1, 0}, .contact = {}};
    const double part = time_step / 0.2;
    const Record deep = record_of({0, -0.12, 0}, {0, 0, 0}, {ColliderStep{floor}});
    CHECK(deep.offset == Approx(-0.12 * (1.0 - part)));
    CHECK(deep.velocity.y() == Approx(0.0).margin(1e-12));  // that would be kept as speed
    const Record shallow = record_of({0, -0.5e-4, 0}, {0, 0, 0}, {ColliderStep{floor}});
    CHECK(shallow.offset == 0.0);
}

TEST_CASE("contacts: planes are tangents of convex bodies, and unit normals have no fault anywhere") {
    std::mt19937 random(5);
    const auto number = [&](double size) { return size * (2.0 * (static_cast<double>(random()) / 0x1p32) - 1.0); };
    const Capsule rod{.a = {-0.2, 0.1, 0}, .b = {0.3, -0.1, 0.1}, .radius = 0.1, .contact = contact};
    const std::vector<ColliderStep> bodies{
        ColliderStep{ball},
        collider_step({rod, {.path = Rotation{.axis = {1, 2, 3}, .degrees_per_second = 400}}}, 0.2, time_step)};
    for (const ColliderStep& body : bodies)
        for (int n = 0; n < 2000; ++n) {
            const Vector position(number(0.6), number(0.6), number(0.6));
            const Record record = record_of(position, {number(20), number(20), number(20)}, {body});
            CHECK(record.normal.norm() == Approx(1.0));
            // The body's farthest point along the normal, by its definition.
            double support = 0.0;
            if (const auto* capsule = std::get_if<Capsule>(&body.shape))
                support = 0.11 + std::max(record.normal.dot(Vector(capsule->a.data())),
                                          record.normal.dot(Vector(capsule->b.data())));
            else
                support = 0.3;
            CHECK(record.offset <= support + 1e-12);
            // At the start it stands no higher than the vertex, or a part of its depth higher.
            const double start_of_plane = record.offset - time_step * record.normal.dot(record.velocity);
            const double radius = body.turning == std::array<double, 9>{} ? 0.3 : 0.11;
            CHECK(start_of_plane <= record.normal.dot(position) + time_step / 0.2 * radius + 1e-9);
        }
}

TEST_CASE("contacts: a place at the very center or axis has a normal all the same") {
    const Capsule rod{.a = {-1, 0, 0}, .b = {1, 0, 0}, .radius = 0.02, .contact = {}};
    for (const ColliderStep& body : {ColliderStep{ball}, ColliderStep{rod}}) {
        const Record record = record_of({0, 0, 0}, {0, 0, 0}, {body});
        CHECK(record.normal.norm() == Approx(1.0));
        CHECK(record.normal.allFinite());
    }
}
