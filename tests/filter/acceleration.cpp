// SPDX-License-Identifier: MIT
#include "filter/stepped.hpp"
#include "support/tolerances.hpp"

#include <apsl/reference.hpp>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace apsl;
using namespace apsl::test;

namespace {

constexpr Options by_areas{.integrates = true, .acceleration_per_vertex = true};
constexpr Options with_all{
    .limits_stretch = true, .integrates = true, .keeps_contacts = true, .bends = true, .acceleration_per_vertex = true};

constexpr Parameters falling(int sub_steps) {
    return {.regularization = 1.2f,
            .sub_steps = sub_steps,
            .tolerance = 3e-4f,
            .acceleration = {0.5f, -9.81f, 0.25f},
            .damping = 0.4f};
}

MovingCloth unlimited_cloth() {
    MovingCloth cloth = moving_cloth(grid(9, 7, 1.0, 0.7, Diagonals::uniform), 1);
    std::fill(cloth.rest_areas.begin(), cloth.rest_areas.end(), 0.0);
    return cloth;
}

}  // namespace

TEST_CASE("acceleration of each vertex: a free cloth in one part, by hand", "[filter][acceleration]") {
    // u = ṽ + (g + a) Δt, x = x̃ + u Δt.
    const MovingCloth cloth = unlimited_cloth();
    Parameters parameters = falling(2);
    parameters.damping = 0.0f;
    const Ended got = step_on_device(cloth, by_areas, parameters);
    const auto time_step = static_cast<double>(parameters.time_step);
    std::vector<double> positions, velocities;
    for (std::size_t n = 0; n < cloth.positions.size(); ++n) {
        const double acceleration = static_cast<double>(parameters.acceleration[n % 3]) + cloth.accelerations[n];
        const bool pinned = cloth.inverse_masses[n / 3] == 0.0;
        velocities.push_back(cloth.velocities[n] + (pinned ? 0.0 : acceleration * time_step));
        positions.push_back(cloth.positions[n] + velocities[n] * time_step);
        if (pinned) CHECK(got.velocities[n] == cloth.velocities[n]);
    }
    CHECK(difference(got.positions, positions) <= elementwise_tolerance(10.0) * norm(positions));
    CHECK(difference(got.velocities, velocities) <= elementwise_tolerance(10.0) * norm(velocities));
}

TEST_CASE("acceleration of each vertex: the device agrees with the reference", "[filter][acceleration]") {
    for (const MovingCloth& cloth : small_cloths())
        for (const std::uint32_t work_group_size : compared_group_sizes()) {
            CAPTURE(cloth.rest_areas.size(), work_group_size);
            Options sized = by_areas;
            sized.work_group_size = work_group_size;
            check_step_against_reference(cloth, sized, falling(3));
            check_step_against_reference(cloth, sized, falling(24));
            sized = with_all;
            sized.work_group_size = work_group_size;
            Parameters parameters = falling(6);
            parameters.stretch_ceiling = 1.05f;
            parameters.bending = 1e-3f;
            check_step_against_reference(cloth, sized, parameters);
        }
}

TEST_CASE("acceleration of each vertex: the same bytes twice, in every layout of positions", "[filter][acceleration]") {
    const MovingCloth cloth = moving_cloth(grid(9, 7, 1.0, 0.7, Diagonals::uniform), 1);
    check_step_in_every_layout(cloth, by_areas, falling(4));
}

TEST_CASE("acceleration of each vertex: zeros leave what a call without them leaves", "[filter][acceleration]") {
    for (MovingCloth cloth : small_cloths()) {
        std::fill(cloth.accelerations.begin(), cloth.accelerations.end(), 0.0);
        const Ended got = step_on_device(cloth, by_areas, falling(6)),
                    want = step_on_device(cloth, {.integrates = true}, falling(6));
        CAPTURE(cloth.rest_areas.size());
        CHECK(difference(got.positions, want.positions) <= elementwise_tolerance(20.0) * norm(want.positions));
        CHECK(difference(got.velocities, want.velocities) <= 1e-4 * norm(want.velocities));
    }
}

TEST_CASE("acceleration of each vertex: two cloths in one limiter are each as in a limiter of their own",
          "[filter][acceleration]") {
    const std::vector<MovingCloth> cloths{moving_cloth(grid(9, 7, 1.0, 0.7, Diagonals::random), 1),
                                          moving_cloth(right_triangle(), 2)};
    check_step_as_alone(cloths, by_areas, falling(6));
}

TEST_CASE("acceleration of each vertex: what is not finite ends the call, but of a pin it is not looked at",
          "[filter][acceleration]") {
    const MovingCloth cloth = moving_cloth(grid(9, 7, 1.0, 0.7, Diagonals::uniform), 1);
    std::size_t free_vertex = 5, pin = 0;
    REQUIRE(cloth.inverse_masses[free_vertex] > 0.0);
    REQUIRE(cloth.inverse_masses[pin] == 0.0);
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        MovingCloth broken = cloth;
        broken.accelerations[3 * free_vertex + 1] = bad;
        const Ended diverged = step_on_device(broken, by_areas, falling(4));
        CHECK(diverged.stats.status == Status::diverged);
        CHECK(diverged.stats.offender == Offender::vertex);
        CHECK(diverged.stats.offender_index == free_vertex);
        CHECK(diverged.positions == cloth.positions);
        CHECK(diverged.velocities == cloth.velocities);

        MovingCloth pinned = cloth;
        pinned.accelerations[3 * pin + 1] = bad;
        const Ended got = step_on_device(pinned, by_areas, falling(4)),
                    want = step_on_device(cloth, by_areas, falling(4));
        CHECK(got.positions == want.positions);
        CHECK(got.velocities == want.velocities);
    }
}

TEST_CASE("acceleration of each vertex: wind from the side draws a curtain out to where drag and weight balance",
          "[filter][acceleration]") {
    // Pinned along its upper edge. A horizontal acceleration a of all free vertices against gravity g: it comes to hang
    // in the plane that leans out by atan(a/g).
    MovingCloth cloth = flat_sheet(13, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
    for (std::size_t n = 0; n < cloth.accelerations.size(); ++n) cloth.accelerations[n] = n % 3 == 2 ? 5.0 : 0.0;
    constexpr Options options{.limits_stretch = true, .integrates = true, .acceleration_per_vertex = true};
    StrainLimiter limiter(device().context, device().id, cloth.topology, options);
    const Parameters parameters{.stretch_ceiling = 1.05f, .acceleration = {0.0f, -9.81f, 0.0f}, .damping = 3.0f};
    for (int frame = 0; frame < 240; ++frame) {
        const Ended end = step_on_device(limiter, cloth, options, parameters);
        REQUIRE(end.stats.status == Status::ok);
        cloth.positions = end.positions;
        cloth.velocities = end.velocities;
    }
    const double* hem = cloth.positions.data() + 3 * (12 * 13 + 6);
    const double* top = cloth.positions.data() + 3 * 6;
    CHECK(std::atan2(std::abs(hem[2] - top[2]), top[1] - hem[1]) == Approx(std::atan2(5.0, 9.81)).margin(0.02));
    CHECK(hem[2] > top[2]);
}

TEST_CASE("acceleration of each vertex: the buffer is asked for with the option, and only then",
          "[filter][acceleration]") {
    const MovingCloth cloth = small_cloths()[0];
    const Owned<cl_command_queue> queue = in_order_queue();
    StrainLimiter accelerates(device().context, device().id, cloth.topology, by_areas);
    StrainLimiter plain(device().context, device().id, cloth.topology, {.integrates = true});
    const CallerBuffers buffers({&cloth, 1}, by_areas);
    Buffers with = buffers.views(), without = with;
    without.accelerations = {};
    CHECK_THROWS_WITH(accelerates.enqueue(queue.get(), without, falling(4)), Catch::Contains("buffers.accelerations"));
    CHECK_THROWS_WITH(plain.enqueue(queue.get(), with, falling(4)),
                      "buffers.accelerations is given, but Options::acceleration_per_vertex is off");
    Buffers past_the_end = with;
    past_the_end.accelerations.offset += sizeof(float);
    CHECK_THROWS_WITH(accelerates.enqueue(queue.get(), past_the_end, falling(4)),
                      Catch::Contains("buffers.accelerations"));
}
