// SPDX-License-Identifier: MIT
#include "embed/variants.hpp"
#include "support/device_cloth.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

using namespace apsl;
using namespace apsl::test;

namespace {

struct Filtered {
    std::vector<float> velocities;
    std::vector<Stats> stats;
};

Filtered in_order_result(StrainLimiter& limiter, const MovingCloth& cloth, const Parameters& parameters) {
    const CallerBuffers buffers({&cloth, 1}, limiter.options());
    const std::vector<Stats> stats = filter(limiter, buffers, {&parameters, 1});
    return {buffers.read_velocities(), stats};
}

cl_int status_of(cl_event event) {
    cl_int status = CL_SUCCESS;
    require_success(clGetEventInfo(event, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof status, &status, nullptr),
                    "clGetEventInfo");
    return status;
}

void check_behind_gate(cl_command_queue queue, const Options& options) {
    const MovingCloth cloth = moving_cloth(grid(17, 17, 1.0, 1.0, Diagonals::alternating), 1);
    const Parameters parameters{.sub_steps = 3};
    StrainLimiter limiter(device().context, device().id, cloth.topology, options);
    const Filtered expected = in_order_result(limiter, cloth, parameters);

    const CallerBuffers buffers({&cloth, 1}, options);
    cl_int status = CL_SUCCESS;
    const Owned<cl_event> gate(clCreateUserEvent(device().context, &status), clReleaseEvent);
    require_success(status, "clCreateUserEvent");
    const cl_event gate_event = gate.get();
    const cl_event limited = limiter.enqueue(queue, buffers.views(), parameters, {&gate_event, 1});
    std::vector<Stats> stats(1);
    const cl_event read = limiter.read_stats(queue, stats, {&limited, 1});
    require_success(clFlush(queue), "clFlush");

    // Long enough for a call of this size many times over, were anything to run ahead of the gate.
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    CHECK(status_of(limited) > CL_COMPLETE);
    CHECK(status_of(read) > CL_COMPLETE);
    const CallerBuffers untouched({&cloth, 1}, options);
    CHECK(same_bytes(buffers.read_velocities(), untouched.read_velocities()));

    require_success(clSetUserEventStatus(gate.get(), CL_COMPLETE), "clSetUserEventStatus");
    CHECK(wait_and_release(read) == CL_COMPLETE);
    CHECK(status_of(limited) == CL_COMPLETE);
    CHECK(wait_and_release(limited) == CL_COMPLETE);
    CHECK(same_bytes(buffers.read_velocities(), expected.velocities));
    CHECK(same_bytes(stats, expected.stats));
    CHECK(stats[0].sub_steps == 3);
}

}  // namespace

TEST_CASE("in-order queue: nothing happens before the wait list fires, then the same bytes", "[embed]") {
    for (const Options& options : variants) {
        CAPTURE(static_cast<int>(options.matrix), static_cast<int>(options.apply), static_cast<int>(options.execution));
        check_behind_gate(in_order_queue().get(), options);
    }
}

TEST_CASE("out-of-order queue: nothing happens before the wait list fires, then the same bytes as in order",
          "[embed]") {
    const Owned<cl_command_queue> queue = out_of_order_queue();
    if (!queue) {
        WARN("the device has no out-of-order queues");
        return;
    }
    for (const Options& options : variants) {
        CAPTURE(static_cast<int>(options.matrix), static_cast<int>(options.apply), static_cast<int>(options.execution));
        check_behind_gate(queue.get(), options);
    }
}

TEST_CASE("several events to wait for, and calls chained by their events on an out-of-order queue", "[embed]") {
    const Owned<cl_command_queue> queue = out_of_order_queue();
    if (!queue) {
        WARN("the device has no out-of-order queues");
        return;
    }
    const MovingCloth cloth = moving_cloth(grid(9, 9, 1.0, 1.0, Diagonals::uniform), 1);
    const Parameters parameters{.sub_steps = 2};
    StrainLimiter limiter(device().context, device().id, cloth.topology);

    // Three calls one after the other, each on what the last one left.
    const CallerBuffers expected({&cloth, 1}, limiter.options());
    for (int call = 0; call < 3; ++call) filter(limiter, expected, {&parameters, 1});

    const CallerBuffers buffers({&cloth, 1}, limiter.options());
    cl_int status = CL_SUCCESS;
    std::vector<cl_event> gates(2);
    for (cl_event& gate : gates) {
        gate = clCreateUserEvent(device().context, &status);
        require_success(status, "clCreateUserEvent");
    }
    const cl_event first = limiter.enqueue(queue.get(), buffers.views(), parameters, gates);
    const cl_event second = limiter.enqueue(queue.get(), buffers.views(), parameters, {&first, 1});
    const cl_event third = limiter.enqueue(queue.get(), buffers.views(), parameters, {&second, 1});
    for (const cl_event gate : gates) require_success(clSetUserEventStatus(gate, CL_COMPLETE), "clSetUserEventStatus");
    CHECK(wait_and_release(third) == CL_COMPLETE);
    CHECK(wait_and_release(first) == CL_COMPLETE);
    CHECK(wait_and_release(second) == CL_COMPLETE);
    CHECK(same_bytes(buffers.read_velocities(), expected.read_velocities()));
    for (const cl_event gate : gates) clReleaseEvent(gate);
}

TEST_CASE("two limiters in one context, calls alternating on two queues", "[embed]") {
    const MovingCloth cloths[] = {moving_cloth(grid(17, 9, 1.0, 1.0, Diagonals::random), 1),
                                  moving_cloth(tetrahedron(), 2)};
    const Parameters parameters{.sub_steps = 2};
    std::vector<StrainLimiter> limiters;
    std::vector<std::vector<float>> expected;
    for (const MovingCloth& cloth : cloths) {
        limiters.emplace_back(device().context, device().id, cloth.topology);
        expected.push_back(in_order_result(limiters.back(), cloth, parameters).velocities);
    }
    const Owned<cl_command_queue> queues[] = {in_order_queue(), in_order_queue()};
    const CallerBuffers buffers[] = {CallerBuffers({&cloths[0], 1}, {}), CallerBuffers({&cloths[1], 1}, {})};
    std::vector<cl_event> events;
    for (std::size_t n = 0; n < 2; ++n)
        events.push_back(limiters[n].enqueue(queues[n].get(), buffers[n].views(), parameters));
    for (std::size_t n = 0; n < 2; ++n) {
        CHECK(wait_and_release(events[n]) == CL_COMPLETE);
        CHECK(same_bytes(buffers[n].read_velocities(), expected[n]));
    }
}
