// SPDX-License-Identifier: MIT
#include "filter/stepped.hpp"
#include "support/tolerances.hpp"

#include <apsl/reference.hpp>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;

namespace {

constexpr Options bending{.limits_stretch = true, .integrates = true, .bends = true};

constexpr Parameters falling(int sub_steps, float rigidity, int iterations) {
    return {.regularization = 1.2f,
            .sub_steps = sub_steps,
            .stretch_ceiling = 1.05f,
            .acceleration = {0.5f, -9.81f, 0.25f},
            .damping = 0.4f,
            .bending = rigidity,
            .bending_iterations = iterations};
}

/// A strip, clamped at its first two columns; 0.2 kg/m².
MovingCloth cantilever() {
    constexpr std::uint32_t columns = 22, rows = 5;
    const Mesh mesh = grid(columns, rows, 0.525, 0.1, Diagonals::uniform);
    MovingCloth cloth = moving_cloth(mesh, 1);
    cloth.positions = mesh.positions;
    cloth.inverse_masses = reference::inverse_masses<double>(*cloth.topology, cloth.rest_areas, 0.2);
    for (std::uint32_t row = 0; row < rows; ++row)
        cloth.inverse_masses[row * columns] = cloth.inverse_masses[row * columns + 1] = 0.0;
    for (double& x : cloth.positions) x = static_cast<float>(x);
    for (double& w : cloth.inverse_masses) w = static_cast<float>(w);
    std::fill(cloth.velocities.begin(), cloth.velocities.end(), 0.0);
    return cloth;
}

/// How far the strip's end comes to hang below its clamp, m.
double rest_of_cantilever(float rigidity, int sub_steps, float time_step, int iterations) {
    MovingCloth cloth = cantilever();
    StrainLimiter limiter(device().context, device().id, cloth.topology, bending);
    const Parameters parameters{.time_step = time_step,
                                .sub_steps = sub_steps,
                                .most_sub_steps = sub_steps,
                                .stretch_ceiling = 1.01f,
                                .acceleration = {0.0f, -9.81f, 0.0f},
                                .damping = 6.0f,
                                .bending = rigidity,
                                .bending_iterations = iterations};
    for (double time = 0.0; time < 2.5; time += static_cast<double>(time_step)) {
        const Ended end = step_on_device(limiter, cloth, bending, parameters);
        REQUIRE(end.stats.status == Status::ok);
        cloth.positions = end.positions;
        cloth.velocities = end.velocities;
    }
    return -cloth.positions[3 * (2 * 22 + 21) + 1];
}

}  // namespace

TEST_CASE("bending: the device agrees with the reference", "[filter][bending]") {
    for (const MovingCloth& cloth : small_cloths())
        for (const Parameters& parameters : {falling(3, 1e-3f, 1), falling(6, 0.02f, 4), falling(6, 50.0f, 2)})
            for (const std::uint32_t work_group_size : compared_group_sizes()) {
                Options sized = bending;
                sized.work_group_size = work_group_size;
                CAPTURE(cloth.rest_areas.size(), parameters.sub_steps, parameters.bending, work_group_size);
                check_step_against_reference(cloth, sized, parameters);
            }
}

TEST_CASE("bending: without rigidity a call is what it is without bending, to the bit", "[filter][bending]") {
    Options unbending = bending;
    unbending.bends = false;
    for (const MovingCloth& cloth : small_cloths()) {
        const Parameters parameters = falling(6, 0.0f, 2);
        const Ended got = step_on_device(cloth, bending, parameters),
                    want = step_on_device(cloth, unbending, parameters);
        if (got.stats.status != Status::ok) continue;  // what counts as worse is not the same
        CHECK(got.positions == want.positions);
        CHECK(got.velocities == want.velocities);
    }
}

TEST_CASE("bending: two cloths in one limiter, one stiff, are each as in a limiter of their own", "[filter][bending]") {
    const std::vector<MovingCloth> cloths{moving_cloth(grid(9, 7, 1.0, 0.7, Diagonals::random), 1),
                                          moving_cloth(right_triangle(), 2),
                                          moving_cloth(grid(8, 11, 1.0, 0.7, Diagonals::uniform), 3)};
    const std::vector<Parameters> parameters{falling(6, 0.5f, 3), falling(6, 1e-3f, 3), falling(6, 0.0f, 1)};
    StrainLimiter limiter(device().context, device().id, topologies_of(cloths), bending);
    const CallerBuffers buffers(cloths, bending);
    filter(limiter, buffers, parameters);
    const std::vector<float> positions = buffers.read_positions();
    std::size_t first = 0;
    for (std::size_t c = 0; c < cloths.size(); ++c) {
        const Ended alone = step_on_device(cloths[c], bending, parameters[c]);
        const std::vector<double> got(positions.begin() + static_cast<std::ptrdiff_t>(first),
                                      positions.begin() + static_cast<std::ptrdiff_t>(first + alone.positions.size()));
        CAPTURE(c);
        CHECK(difference(got, alone.positions) <= elementwise_tolerance(20.0) * norm(alone.positions));
        first += alone.positions.size();
    }
}

TEST_CASE("bending: a clamped strip hangs as far whatever the steps", "[filter][bending]") {
    // Of the reference with 120 sub-steps.
    for (const auto& [rigidity, converged] : {std::pair{1e-1f, 0.1843}, {1e-2f, 0.4478}, {1e-3f, 0.4949}}) {
        CAPTURE(rigidity);
        CHECK(rest_of_cantilever(rigidity, 10, 1.0f / 30.0f, 40) == Approx(converged).epsilon(0.03));
        CHECK(rest_of_cantilever(rigidity, 30, 1.0f / 60.0f, 6) == Approx(converged).epsilon(0.03));
        CHECK(rest_of_cantilever(rigidity, 10, 1.0f / 240.0f, 5) == Approx(converged).epsilon(0.03));
    }
}

TEST_CASE("bending: a mesh without hinges has nothing to bend, and needs no buffer of them", "[filter][bending]") {
    const MovingCloth cloth = moving_cloth(right_triangle(), 1);
    REQUIRE(cloth.rest_hinges.empty());
    Options unbending = bending;
    unbending.bends = false;
    const Parameters parameters = falling(6, 0.5f, 3);
    StrainLimiter limiter(device().context, device().id, cloth.topology, bending);
    const CallerBuffers buffers({&cloth, 1}, bending);
    const Owned<cl_command_queue> queue = in_order_queue();
    cl_int status = CL_SUCCESS;
    const Owned<cl_event> gate(clCreateUserEvent(device().context, &status), clReleaseEvent);
    require_success(status, "a gate");
    const cl_event held = gate.get();
    const cl_event rest = limiter.enqueue_rest_hinges(queue.get(), buffers.views().positions, {}, {&held, 1});
    cl_int state = CL_COMPLETE;
    require_success(clGetEventInfo(rest, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof state, &state, nullptr), "status");
    CHECK(state != CL_COMPLETE);  // it waits for what it was told to
    require_success(clSetUserEventStatus(gate.get(), CL_COMPLETE), "opening the gate");
    require_success(wait_and_release(rest), "rest hinges");

    Buffers views = buffers.views();
    views.rest_hinges = {};
    require_success(wait_and_release(limiter.enqueue(queue.get(), views, parameters)), "the step");
    const std::vector<float> got = buffers.read_positions();
    CHECK(std::vector<double>(got.begin(), got.end()) ==
          step_on_device(cloth, unbending, falling(6, 0.0f, 3)).positions);
}

TEST_CASE("bending: rest hinges from rest positions, of the device's own", "[filter][bending]") {
    const MovingCloth cloth = moving_cloth(grid(9, 7, 1.0, 0.7, Diagonals::random), 1);
    StrainLimiter limiter(device().context, device().id, cloth.topology, bending);
    const CallerBuffers buffers({&cloth, 1}, bending, 5);
    buffers.rest_hinges.read();
    const Owned<cl_command_queue> queue = in_order_queue();
    const BufferView hinges = buffers.views().rest_hinges;
    require_success(wait_and_release(limiter.enqueue_rest_hinges(queue.get(), buffers.views().positions, hinges)),
                    "the rest hinges");
    const std::vector<float> got = buffers.rest_hinges.read();
    const std::vector<double> want = reference::rest_hinges<double>(*cloth.topology, cloth.positions);
    for (std::size_t n = 0; n < want.size(); ++n)
        CHECK(static_cast<double>(got[5 + n]) == Approx(want[n]).epsilon(1e-4).margin(1e-5));

    Options unbending = bending;
    unbending.bends = false;
    StrainLimiter other(device().context, device().id, cloth.topology, unbending);
    CHECK_THROWS_WITH(other.enqueue_rest_hinges(queue.get(), buffers.views().positions, hinges),
                      "rest hinges are asked for, but Options::bends is off");
    CHECK_THROWS_WITH(other.enqueue(queue.get(), buffers.views(), Parameters{}),
                      "buffers.rest_hinges is given, but Options::bends is off");
    Buffers without = buffers.views();
    without.rest_hinges = {};
    CHECK_THROWS_WITH(limiter.enqueue(queue.get(), without, Parameters{}), Catch::Contains("buffers.rest_hinges"));
}
