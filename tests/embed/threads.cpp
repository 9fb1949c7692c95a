// SPDX-License-Identifier: MIT
//
// Limiters in threads of their own, in one context and in several: the bytes of one after the other. Meant for the
// thread sanitizer (preset tsan) as well, so nothing here counts calls or shares a queue.
#include "support/device_cloth.hpp"

#include <apsl/apsl.h>

#include <catch2/catch.hpp>
#include <functional>
#include <latch>
#include <string>
#include <thread>

using namespace apsl;
using namespace apsl::test;

namespace {

constexpr int call_count = 3;

struct Filtered {
    std::vector<float> velocities;  ///< m/s, [3V], after the last call
    std::vector<Stats> stats;       ///< one entry a call
};

std::vector<float> to_float(const std::vector<double>& numbers) {
    return {numbers.begin(), numbers.end()};
}

Owned<cl_mem> buffer_of(cl_context context, const std::vector<double>& numbers) {
    std::vector<float> values = to_float(numbers);
    cl_int status = CL_SUCCESS;
    Owned<cl_mem> made(clCreateBuffer(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, values.size() * sizeof(float),
                                      values.data(), &status),
                       clReleaseMemObject);
    require_success(status, "clCreateBuffer");
    return made;
}

Owned<cl_context> new_context() {
    cl_int status = CL_SUCCESS;
    Owned<cl_context> made(clCreateContext(nullptr, 1, &device().id, nullptr, nullptr, &status), clReleaseContext);
    require_success(status, "clCreateContext");
    return made;
}

/// A limiter, queue and buffers made, `call_count` calls one on the other, all of it released.
Filtered filtered_in(cl_context context, const MovingCloth& cloth, const Options& options) {
    cl_int status = CL_SUCCESS;
    const Owned<cl_command_queue> queue(clCreateCommandQueue(context, device().id, 0, &status), clReleaseCommandQueue);
    require_success(status, "clCreateCommandQueue");
    const Owned<cl_mem> positions = buffer_of(context, cloth.positions),
                        velocities = buffer_of(context, cloth.velocities),
                        inverse_masses = buffer_of(context, cloth.inverse_masses),
                        rest_areas = buffer_of(context, cloth.rest_areas);
    const Buffers buffers{.positions = {positions.get()},
                          .velocities = {velocities.get()},
                          .inverse_masses = {inverse_masses.get()},
                          .rest_areas = {rest_areas.get()}};
    StrainLimiter limiter(context, device().id, cloth.topology, options);
    Filtered result{std::vector<float>(cloth.velocities.size()), std::vector<Stats>(call_count)};
    for (Stats& stats : result.stats) {
        const cl_event limited = limiter.enqueue(queue.get(), buffers, Parameters{.sub_steps = 3});
        const cl_event read = limiter.read_stats(queue.get(), {&stats, 1}, {&limited, 1});
        require_success(clReleaseEvent(limited), "clReleaseEvent");
        require_success(wait_and_release(read), "the statistics");
    }
    require_success(
        clEnqueueReadBuffer(queue.get(), velocities.get(), CL_TRUE, 0, result.velocities.size() * sizeof(float),
                            result.velocities.data(), 0, nullptr, nullptr),
        "clEnqueueReadBuffer");
    return result;
}

/// All of them at once, each in a thread of its own. What one throws is thrown here.
void at_once(const std::vector<std::function<void()>>& actions) {
    std::latch start(static_cast<std::ptrdiff_t>(actions.size()));
    std::vector<std::exception_ptr> failures(actions.size());
    std::vector<std::thread> threads;
    for (std::size_t n = 0; n < actions.size(); ++n)
        threads.emplace_back([&, n] {
            start.arrive_and_wait();
            try {
                actions[n]();
            } catch (...) {
                failures[n] = std::current_exception();
            }
        });
    for (std::thread& thread : threads) thread.join();
    for (const std::exception_ptr& failure : failures)
        if (failure) std::rethrow_exception(failure);
}

const std::vector<MovingCloth>& cloths() {
    static const std::vector<MovingCloth> made{moving_cloth(grid(17, 17, 1.0, 1.0, Diagonals::alternating), 1),
                                               moving_cloth(grid(13, 9, 1.0, 1.0, Diagonals::random), 2)};
    return made;
}

/// Each cloth with each way to run: the limiters that the threads have.
constexpr Execution executions[] = {Execution::many_groups, Execution::one_group};

void check_threads(const std::function<cl_context(std::size_t thread)>& context_of) {
    for (const Execution execution : executions) {
        CAPTURE(static_cast<int>(execution));
        const Options options{.execution = execution};
        std::vector<Filtered> expected;
        for (const MovingCloth& cloth : cloths()) expected.push_back(filtered_in(device().context, cloth, options));
        std::vector<Filtered> got(cloths().size());
        std::vector<std::function<void()>> actions;
        for (std::size_t n = 0; n < got.size(); ++n)
            actions.emplace_back([&, n] { got[n] = filtered_in(context_of(n), cloths()[n], options); });
        at_once(actions);
        for (std::size_t n = 0; n < got.size(); ++n) {
            CHECK(same_bytes(got[n].velocities, expected[n].velocities));
            CHECK(same_bytes(got[n].stats, expected[n].stats));
            CHECK_FALSE(same_bytes(got[n].velocities, to_float(cloths()[n].velocities)));
        }
    }
}

}  // namespace

TEST_CASE("limiters in two threads, each with a context of its own: the bytes of one after the other", "[threads]") {
    const std::vector<Owned<cl_context>> contexts{new_context(), new_context()};
    check_threads([&](std::size_t thread) { return contexts[thread].get(); });
}

TEST_CASE("limiters in two threads, one context and two queues: the bytes of one after the other", "[threads]") {
    check_threads([](std::size_t) { return device().context; });
}

TEST_CASE("two threads make limiters from one topology, and end with it", "[threads]") {
    const MovingCloth& cloth = cloths()[0];
    const Filtered expected = filtered_in(device().context, cloth, {});
    std::vector<Filtered> got(2);
    std::vector<std::function<void()>> actions;
    for (Filtered& result : got) actions.emplace_back([&] { result = filtered_in(device().context, cloth, {}); });
    at_once(actions);
    for (const Filtered& result : got) CHECK(same_bytes(result.velocities, expected.velocities));
}

TEST_CASE("the C interface in two threads: each has the line of its own last error", "[threads]") {
    const std::uint32_t triangle[] = {0, 1, 2};
    std::vector<std::string> messages(2);
    std::vector<std::function<void()>> actions;
    for (std::size_t n = 0; n < messages.size(); ++n)
        actions.emplace_back([&, n] {
            for (int call = 0; call < 100; ++call) {
                apsl_topology* topology = nullptr;
                // Too few vertices: 1 in one thread, 2 in the other.
                apsl_topology_create(triangle, 1, n + 1, &topology);
                messages[n] = apsl_last_error();
            }
        });
    at_once(actions);
    CHECK(messages[0] != messages[1]);
    for (const std::string& message : messages) CHECK_FALSE(message.empty());
}
