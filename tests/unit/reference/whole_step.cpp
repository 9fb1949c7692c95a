// SPDX-License-Identifier: MIT
#include "unit/reference/sample_cloths.hpp"

#include <apsl/error.hpp>
#include <apsl/reference.hpp>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::reference;

namespace {

constexpr Options integrating{.integrates = true};
constexpr Options accelerating{.integrates = true, .acceleration_per_vertex = true};

// A triangle with two pinned vertices and a third above them: along its altitude one dimension, solvable by hand.
struct Altitude {
    std::shared_ptr<const Topology> topology = Topology::build(std::vector<Triangle>{{0, 1, 2}}, 3);
    std::vector<double> positions{0, 0, 0, 1, 0, 0, 0.5, 1, 0};
    std::vector<double> velocities = std::vector<double>(9, 0.0);
    std::vector<double> inverse_masses{0, 0, 2};
    std::vector<double> rest_areas{0.5};
    std::vector<double> accelerations = {};
    std::vector<std::uint32_t> tether_anchors = {};
    std::vector<double> tether_lengths = {};

    Stats step(const Parameters& parameters, const Options& options = integrating) {
        StrainLimiter limiter(topology, options);
        limiter.enqueue({.positions = positions,
                         .velocities = velocities,
                         .inverse_masses = inverse_masses,
                         .rest_areas = rest_areas,
                         .regularization = {},
                         .end_positions = positions,
                         .accelerations = accelerations,
                         .tether_anchors = tether_anchors,
                         .tether_lengths = tether_lengths},
                        parameters);
        return limiter.read_stats();
    }
};

constexpr Parameters by_hand(int sub_steps) {
    return {.time_step = 0.5f, .regularization = 2.0f, .sub_steps = sub_steps, .tolerance = 1e-6f};
}

}  // namespace

TEST_CASE("a whole step: along an altitude, by hand") {
    // Three sub-steps, so two parts of h = 0.25 s; 1.6 m/s² upwards. u = 0.4: height 1.1, the solve takes 0.05 off, u =
    // 0.4 − 0.2 = 0.2. u = 0.6: 1.05 + 0.15 = 1.2, 0.1 off, u = 0.6 − 0.4 = 0.2. The last mends the position
    // alone: 1.05.
    Altitude triangle;
    Parameters parameters = by_hand(3);
    parameters.acceleration = {0.0f, 1.6f, 0.0f};
    const Stats stats = triangle.step(parameters);
    CHECK(stats.sub_steps == 3);
    CHECK(stats.status == Status::ok);
    CHECK(triangle.positions[7] == Approx(1.05));
    CHECK(triangle.velocities[7] == Approx(0.2));
    CHECK(stats.max_area_change == Approx(0.05f));
    CHECK(stats.initial_max_area_change == Approx(0.3f));  // 0.1 + 0.2 without a limit
}

TEST_CASE("a whole step: free motion is that of symplectic Euler in the parts, with and without damping") {
    for (const float damping : {0.0f, 0.7f}) {
        Altitude triangle;
        triangle.rest_areas = {0.0};  // not limited
        triangle.velocities[6] = 0.3;
        triangle.velocities[0] = 0.25;  // of a pin
        Parameters parameters = by_hand(5);
        parameters.acceleration = {1.0f, -9.81f, 2.0f};
        parameters.damping = damping;
        const Altitude before = triangle;
        triangle.step(parameters);
        std::vector<double> x = before.positions, v = before.velocities;
        const double h = 0.5 / 4, kept = std::exp(-static_cast<double>(damping) * h);
        for (int part = 0; part < 4; ++part)
            for (std::size_t k = 6; k < 9; ++k) {
                v[k] = kept * (v[k] + h * static_cast<double>(parameters.acceleration[k - 6]));
                x[k] += h * v[k];
            }
        x[0] += 0.5 * 0.25;
        for (std::size_t k = 0; k < 9; ++k) {
            CAPTURE(damping, k);
            CHECK(triangle.positions[k] == Approx(x[k]).margin(1e-12));
            CHECK(triangle.velocities[k] == Approx(v[k]).margin(1e-12));
        }
        CHECK(triangle.velocities[0] == 0.25);
    }
}

TEST_CASE("a whole step: a vertex' own acceleration adds to that of all, by hand") {
    // Two sub-steps, so one part of 0.5 s: u = ṽ + (g + a) Δt, and x moves on by u Δt. What is pinned stays.
    Altitude triangle;
    triangle.rest_areas = {0.0};  // not limited
    triangle.velocities[6] = 0.3;
    triangle.accelerations = {7, 7, 7, 7, 7, 7, 0.2, -0.4, 0.6};
    Parameters parameters = by_hand(2);
    parameters.acceleration = {1.0f, -9.0f, 0.0f};
    triangle.step(parameters, accelerating);
    CHECK(triangle.velocities == std::vector<double>{0, 0, 0, 0, 0, 0, 0.3 + 1.2 * 0.5, -9.4 * 0.5, 0.6 * 0.5});
    for (std::size_t n = 0; n < 9; ++n)
        CHECK(triangle.positions[n] == Approx(Altitude().positions[n] + 0.5 * triangle.velocities[n]));
}

TEST_CASE("a whole step: it makes no difference whether all share an acceleration or each has the same") {
    for (const float damping : {0.0f, 0.7f}) {
        Altitude shared, own;
        own.accelerations = {0, 1.5, 0, 0, 1.5, 0, 0, 1.5, 0};
        Parameters parameters = by_hand(5);
        parameters.damping = damping;
        own.step(parameters, accelerating);
        parameters.acceleration = {0.0f, 1.5f, 0.0f};
        const Stats stats = shared.step(parameters);
        CHECK(stats.sub_steps == 5);
        for (std::size_t n = 0; n < 9; ++n) {
            CAPTURE(damping, n);
            CHECK(own.positions[n] == Approx(shared.positions[n]).margin(1e-12));
            CHECK(own.velocities[n] == Approx(shared.velocities[n]).margin(1e-12));
        }
    }
}

TEST_CASE("a whole step: a tether keeps its vertex within reach of a pin, by hand") {
    // Two parts of 0.25 s; nothing is limited. The vertex starts 1 m above its anchor, which moves along the line to
    // it, with a tether of 1.05 m. Held in a part, it ends that part 1.05 m from where the anchor is then.
    struct Case {
        double speed, anchor_speed, end, end_speed;
    };
    for (const auto& [speed, anchor_speed, end, end_speed] :
         {Case{0.1, 0.0, 1.05, 0.1},      // 1.025, 1.05: as far as it reaches
          Case{0.4, 0.0, 1.05, 0.0},      // 1.05 at 0.2 m/s; held there
          Case{0.4, 0.08, 1.09, 0.08},    // 1.07 at 0.28 m/s; 1.09
          Case{0.0, -0.8, 0.65, -0.8},    // drawn after its anchor: 0.85 at −0.6 m/s; 0.65
          Case{-1.0, 0.0, 0.5, -1.0}}) {  // towards it: nothing holds
        Altitude triangle;
        triangle.positions = {0.5, 0, 0, 1, 0, 0, 0.5, 1, 0};
        triangle.rest_areas = {0.0};
        triangle.velocities[7] = speed;
        triangle.velocities[1] = anchor_speed;
        triangle.tether_anchors = {0, 0, 1, 1, 0, 1};
        triangle.tether_lengths = {0.1, 0.1, 0.1, 0.1, 1.05, 0.0};  // of a pin none counts, nor one of length 0
        triangle.step(by_hand(3), {.integrates = true, .tethers_per_vertex = 2});
        CAPTURE(speed, anchor_speed);
        CHECK(triangle.positions[6] == 0.5);
        CHECK(triangle.positions[7] == Approx(end));
        CHECK(triangle.velocities[7] == Approx(end_speed).margin(1e-12));
        CHECK(triangle.positions[1] == Approx(0.5 * anchor_speed));
        CHECK(triangle.velocities[1] == anchor_speed);
    }
}

TEST_CASE("a whole step: what starts out of reach gets no further, and is not thrown back, by hand") {
    for (const double speed : {0.3, 0.0, -0.3}) {
        Altitude triangle;
        triangle.positions = {0, 0, 0, 1, 0, 0, 0, 1.4, 0};
        triangle.velocities[7] = speed;
        triangle.rest_areas = {0.0};
        triangle.tether_anchors = {0, 0, 0};
        triangle.tether_lengths = {0.0, 0.0, 1.0};
        triangle.step(by_hand(3), {.integrates = true, .tethers_per_vertex = 1});
        CAPTURE(speed);
        CHECK(triangle.velocities[7] == Approx(std::min(speed, 0.0)).margin(1e-12));
        CHECK(triangle.positions[7] == Approx(1.4 + 0.5 * std::min(speed, 0.0)));
    }
}

TEST_CASE("a whole step: anchors further apart than two tethers reach both let go as far, by hand") {
    // Anchors 1 m apart, tethers of 0.2 and 0.3 m, and so of 0.4 and 0.6: on the line between them the vertex goes as
    // far as where these meet.
    for (const double start : {0.3, 0.35, 0.4, 0.45, 0.5}) {
        Altitude triangle;
        const double speed = start > 0.4 ? -0.2 : 0.2;
        triangle.positions = {0, 0, 0, 1, 0, 0, start, 0, 0};
        triangle.velocities[6] = speed;
        triangle.rest_areas = {0.0};
        triangle.tether_anchors = {0, 0, 0, 0, 0, 1};
        triangle.tether_lengths = {0.0, 0.0, 0.0, 0.0, 0.2, 0.3};
        triangle.step(by_hand(3), {.integrates = true, .tethers_per_vertex = 2});
        CAPTURE(start);
        CHECK(triangle.positions[6] == Approx(0.4));
        CHECK(triangle.velocities[6] ==
              Approx(std::abs(start - 0.4) > 0.09 ? speed : 0.0).margin(1e-6));  // just there, or stopped
    }
}

TEST_CASE("a whole step: what hangs by a tether at rest stays at rest, however many parts there are") {
    for (const int sub_steps : {2, 10, 40}) {
        Altitude triangle;
        triangle.rest_areas = {0.0};
        triangle.tether_anchors = {0, 0, 0};
        triangle.tether_lengths = {0.0, 0.0, std::hypot(0.5, 1.0)};
        Parameters parameters = by_hand(sub_steps);
        parameters.time_step = 1.0f / 60.0f;
        parameters.acceleration = {0.5f * 9.81f, 9.81f, 0.0f};
        for (int step = 0; step < 20; ++step) triangle.step(parameters, {.integrates = true, .tethers_per_vertex = 1});
        CAPTURE(sub_steps);
        CHECK(triangle.positions[6] == Approx(0.5));
        CHECK(triangle.positions[7] == Approx(1.0));
        CHECK(std::abs(triangle.velocities[7]) < 1e-6);
    }
}

TEST_CASE("a whole step: what hangs at rest stays at rest, however many parts there are") {
    // Gravity draws the vertex away from its edge; the area holds it. α is a compliance: what it yields is known.
    for (const int sub_steps : {2, 10, 40}) {
        Altitude triangle;
        Parameters parameters = by_hand(sub_steps);
        parameters.time_step = 1.0f / 60.0f;
        parameters.regularization = 1.0f;
        parameters.acceleration = {0.0f, 9.81f, 0.0f};
        for (int step = 0; step < 20; ++step) triangle.step(parameters);
        CAPTURE(sub_steps);
        CHECK(triangle.positions[7] == Approx(1.0).epsilon(1e-6));
        CHECK(std::abs(triangle.velocities[7]) < 1e-4);
    }
}

TEST_CASE("a whole step: what is not finite leaves positions and velocities alone") {
    Altitude triangle;
    Parameters parameters = by_hand(3);
    triangle.velocities[7] = std::numeric_limits<double>::infinity();
    const Altitude before = triangle;
    CHECK(triangle.step(parameters).status == Status::diverged);
    CHECK(triangle.positions == before.positions);
    CHECK(triangle.velocities == before.velocities);
}

TEST_CASE("a whole step: what it needs") {
    Altitude triangle;
    const auto message = [&](const Parameters& parameters, const Options& options) {
        try {
            validate(options, parameters);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    CHECK(message({.sub_steps = 1}, integrating) == "sub_steps is 1, expected at least 2: integrates is on");
    CHECK(message({.stepping = Stepping::whole_step}, integrating) ==
          "stepping is whole_step, which does not go with integrates");
    CHECK(message({.acceleration = {0.0f, -9.81f, 0.0f}}, {}) ==
          "acceleration or damping is given, but integrates is off");
    CHECK(message({.damping = 0.5f}, {}) == "acceleration or damping is given, but integrates is off");
    CHECK(message({.acceleration = {0.0f, std::numeric_limits<float>::infinity(), 0.0f}}, integrating) ==
          "acceleration is inf, expected finite numbers (m/s²)");
    CHECK(message({.damping = -1.0f}, integrating) == "damping is -1, expected a finite number >= 0 (1/s)");
    CHECK(message({}, {.execution = Execution::one_group, .integrates = true}) ==
          "integrates is on, which needs execution many_groups");
    CHECK(message({}, {.positions_only = true, .integrates = true}) ==
          "integrates is on, which needs velocities: positions_only is on");
    CHECK(message({}, {.tethers_per_vertex = 1}) == "tethers_per_vertex is 1, which needs integrates");
    CHECK(message({}, {.integrates = true, .tethers_per_vertex = 5}) ==
          "tethers_per_vertex is 5, expected a whole number >= 0 and <= 4");
    CHECK_THROWS_WITH(triangle.step({}, {.integrates = true, .tethers_per_vertex = 2}),
                      "tether_anchors holds 0 numbers, expected 6");
    triangle.tether_anchors.assign(3, 0);
    triangle.tether_lengths = {0, -1, 0};
    CHECK_THROWS_WITH(triangle.step({}, {.integrates = true, .tethers_per_vertex = 1}),
                      "tether_lengths of tether 1 is -1, expected a finite number >= 0 (m)");
    CHECK_THROWS_WITH(triangle.step({}, integrating), "tether_anchors holds 3 numbers, expected 0");
    triangle.tether_anchors.clear();
    triangle.tether_lengths.clear();
    CHECK(message({}, {.acceleration_per_vertex = true}) == "acceleration_per_vertex is on, which needs integrates");
    CHECK_THROWS_WITH(triangle.step({}, accelerating), "accelerations holds 0 numbers, expected 9");
    triangle.accelerations.assign(9, 0.0);
    CHECK_THROWS_WITH(triangle.step({}, integrating), "accelerations holds 9 numbers, expected 0");
    triangle.accelerations[7] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(triangle.step({}, accelerating),
                      "accelerations of number 7 is nan, expected a finite number (m/s2)");
    triangle.accelerations.clear();
    CHECK_THROWS_WITH(
        StrainLimiter(triangle.topology, integrating)
            .enqueue({triangle.positions, triangle.velocities, triangle.inverse_masses, triangle.rest_areas, {}}, {}),
        Catch::Contains("end_positions"));
}
