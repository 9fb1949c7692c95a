// SPDX-License-Identifier: MIT
#include "pipeline/pins.hpp"

#include "pipeline/advance.hpp"
#include "pipeline/implicit_springs.hpp"
#include "sample_cloth.hpp"

#include <apsl/error.hpp>
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <numbers>

using namespace apsl;
using namespace apsl::scenes;

namespace {

constexpr double time_step = 1.0 / 60.0;

test::Mesh strip() {
    return test::grid(3, 2, 2.0, 1.0, test::Diagonals::uniform);
}

}  // namespace

TEST_CASE("pins: turned ones land on their circle, hundreds of steps on") {
    // Axis along x through a center off the origin; vertices at z = ±0.5 go round it.
    ClothState cloth = sample_cloth(strip(), {0, 5});
    const Rotation rotation{
        .axis = {3.0, 0.0, 0.0}, .degrees_per_second = 90.0, .center = std::array<double, 3>{0.0, 0.2, 0.0}};
    const Pins pins(cloth, {PinGroup{{0, 5}, {.path = rotation}}});
    for (int step = 0; step < 600; ++step) {
        const double time = step * time_step;
        pins.set_velocities(cloth, time, time_step);
        advance_positions(cloth, time_step);
        const double angle = 0.5 * std::numbers::pi * (time + time_step);
        for (const std::size_t vertex : {0, 5}) {
            const double z = cloth.rest_positions[3 * vertex + 2];
            CHECK(cloth.positions[3 * vertex] == Approx(cloth.rest_positions[3 * vertex]).margin(1e-12));
            CHECK(cloth.positions[3 * vertex + 1] ==
                  Approx(0.2 - 0.2 * std::cos(angle) - z * std::sin(angle)).margin(1e-12));
            CHECK(cloth.positions[3 * vertex + 2] ==
                  Approx(-0.2 * std::sin(angle) + z * std::cos(angle)).margin(1e-12));
        }
    }
}

TEST_CASE("pins: a group turns about its own centroid where no center is given") {
    ClothState cloth = sample_cloth(strip(), {2, 5});  // x = 1, z = ∓0.5
    const Pins pins(cloth, {PinGroup{{2, 5}, {.path = Rotation{.axis = {1, 0, 0}, .degrees_per_second = 180.0}}}});
    for (int step = 0; step < 60; ++step) {
        pins.set_velocities(cloth, step * time_step, time_step);
        advance_positions(cloth, time_step);
    }
    CHECK(cloth.positions[8] == Approx(0.5).margin(1e-12));
    CHECK(cloth.positions[17] == Approx(-0.5).margin(1e-12));
    CHECK(cloth.positions[7] == Approx(0.0).margin(1e-12));
}

TEST_CASE("pins: carried ones start and stop when told, and then keep every bit") {
    ClothState cloth = sample_cloth(strip(), {0});
    const Pins pins(cloth, {PinGroup{{0}, {.path = Translation{{0.3, 0.0, -0.6}}, .start = 0.5, .stop = 1.0}}});
    CHECK(pins.moving());
    std::vector<double> stopped;
    for (int step = 0; step < 120; ++step) {
        const double time = step * time_step;
        pins.set_velocities(cloth, time, time_step);
        advance_positions(cloth, time_step);
        const double moving = std::clamp(time + time_step - 0.5, 0.0, 0.5);
        CHECK(cloth.positions[0] == Approx(-1.0 + 0.3 * moving).margin(1e-12));
        CHECK(cloth.positions[2] == Approx(-0.5 - 0.6 * moving).margin(1e-12));
        if (time + time_step < 0.5 - 1e-9) CHECK(cloth.positions == cloth.rest_positions);
        if (step == 65) stopped = cloth.positions;
    }
    CHECK(cloth.positions == stopped);
}

TEST_CASE("pins: held ones lose any velocity they had and keep every bit") {
    ClothState cloth = sample_cloth(strip(), {1, 4});
    cloth.velocities.assign(18, 1.0);
    const Pins pins(cloth, {PinGroup{{1, 4}, {}}});
    CHECK_FALSE(pins.moving());
    pins.set_velocities(cloth, 0.0, time_step);
    advance_positions(cloth, time_step);
    for (const std::size_t vertex : {1, 4})
        for (std::size_t i = 3 * vertex; i < 3 * vertex + 3; ++i) CHECK(cloth.positions[i] == cloth.rest_positions[i]);
    CHECK(cloth.positions[0] != cloth.rest_positions[0]);
}

TEST_CASE("pins: the springs do not pull a moving pin off its path, and the cloth follows") {
    ClothState cloth = sample_cloth(test::grid(5, 5, 1.0, 1.0, test::Diagonals::uniform), {0, 4});
    const Pins pins(cloth, {PinGroup{{0, 4}, {.path = Translation{{1.0, 0.0, 0.0}}}}});
    ImplicitSprings integrator(cloth, stretch_springs(*cloth.topology, cloth.rest_positions, 100.0), 2.0);
    for (int step = 0; step < 120; ++step) {
        pins.set_velocities(cloth, step * time_step, time_step);
        integrator.advance_velocities(cloth, {0.0, 0.0, 0.0}, time_step);
        advance_positions(cloth, time_step);
    }
    CHECK(cloth.positions[0] == Approx(-0.5 + 2.0).margin(1e-12));
    CHECK(cloth.positions[3 * 24] > 1.0);
}

TEST_CASE("pins: the last group that names a vertex leads it, all vertices are listed once") {
    const std::vector<PinGroup> groups{{{0, 2}, {}}, {{5, 2}, {.path = Translation{{1.0, 0.0, 0.0}}}}};
    CHECK(pinned_vertices(groups) == std::vector<std::uint32_t>{0, 2, 5});
    ClothState cloth = sample_cloth(strip(), pinned_vertices(groups));
    Pins(cloth, groups).set_velocities(cloth, 0.0, 0.5);
    CHECK(cloth.velocities[0] == 0.0);
    CHECK(cloth.velocities[6] == Approx(1.0).epsilon(1e-14));
    CHECK(cloth.velocities[15] == Approx(1.0).epsilon(1e-14));
}

TEST_CASE("pins: what cannot be followed is an error that names the group") {
    const ClothState cloth = sample_cloth(strip(), {0});
    const auto pins_of = [&](Motion motion, std::vector<std::uint32_t> vertices = {0}) {
        return Pins(cloth, {PinGroup{{0}, {}}, PinGroup{std::move(vertices), motion}});
    };
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(pins_of({}, {6}), Catch::Contains("group 1") && Catch::Contains("vertex 6"));
    CHECK_THROWS_WITH(pins_of({}, {1}), Catch::Contains("not pinned"));
    CHECK_THROWS_WITH(pins_of({.path = Rotation{.axis = {0, 0, 0}}}), Catch::Contains("axis"));
    CHECK_THROWS_WITH(pins_of({.path = Rotation{.degrees_per_second = not_a_number}}), Catch::Contains("degrees"));
    CHECK_THROWS_WITH(pins_of({.path = Translation{{0, not_a_number, 0}}}), Catch::Contains("velocity"));
    CHECK_THROWS_WITH(pins_of({.path = {}, .start = 1.0, .stop = 0.5}), Catch::Contains("stop"));
    ClothState moving = cloth;
    CHECK_THROWS_WITH(pins_of({}).set_velocities(moving, 0.0, 0.0), Catch::Contains("time_step"));
}
