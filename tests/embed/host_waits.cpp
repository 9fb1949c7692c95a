// SPDX-License-Identifier: MIT
#include "embed/opencl_calls.hpp"
#include "embed/variants.hpp"
#include "support/device_cloth.hpp"

#include <catch2/catch.hpp>

using namespace apsl;
using namespace apsl::test;

TEST_CASE("enqueue waits for nothing, allocates nothing and reads nothing back", "[embed]") {
    const std::vector<MovingCloth> cloths{moving_cloth(grid(9, 9, 1.0, 1.0, Diagonals::alternating), 1),
                                          moving_cloth(tetrahedron(), 2)};
    const std::vector<std::shared_ptr<const Topology>> topologies{cloths[0].topology, cloths[1].topology};
    const std::vector<Parameters> parameters{{.sub_steps = 2}, {.sub_steps = 3, .max_iterations = 7}};
    for (const Options& options : variants)
        for (const bool in_order : {true, false}) {
            CAPTURE(static_cast<int>(options.matrix), static_cast<int>(options.apply),
                    static_cast<int>(options.execution), in_order);
            const CallerBuffers buffers(cloths, options);
            StrainLimiter limiter(device().context, device().id, topologies, options);
            const Owned<cl_command_queue> queue = in_order ? in_order_queue() : out_of_order_queue();
            if (!queue) continue;  // the device has no out-of-order queues

            const OpenClCalls before = opencl_calls();
            const cl_event event = limiter.enqueue(queue.get(), buffers.views(), parameters);
            const OpenClCalls after = opencl_calls();
            require_success(wait_and_release(event), "the filter");
            // At least one command a launch: otherwise nothing was counted at all. In one group that is the
            // parameters, the filter and, in order, a marker.
            if (options.execution == Execution::one_group)
                CHECK(after.commands - before.commands == (in_order ? 3 : 2));
            else
                CHECK(after.commands - before.commands >= 3 * 4);
            CHECK(after.host_waits == before.host_waits);
            CHECK(after.blocking_calls == before.blocking_calls);
            CHECK(after.reads == before.reads);
            CHECK(after.allocations == before.allocations);
            CHECK(after.releases == before.releases);
            CHECK(after.builds == before.builds);

            std::vector<Stats> stats(2);
            const OpenClCalls before_stats = opencl_calls();
            const cl_event read = limiter.read_stats(queue.get(), stats);
            const OpenClCalls after_stats = opencl_calls();
            require_success(wait_and_release(read), "the statistics");
            CHECK(after_stats.reads == before_stats.reads + 1);
            CHECK(after_stats.blocking_calls == before_stats.blocking_calls);
            CHECK(after_stats.host_waits == before_stats.host_waits);
            CHECK(stats[0].sub_steps == 2);
            CHECK(stats[1].sub_steps == 3);
        }
}

TEST_CASE("scratch_bytes is every byte the limiter allocates, and destruction gives all of it back", "[embed]") {
    const MovingCloth cloth = moving_cloth(grid(9, 9, 1.0, 1.0, Diagonals::alternating), 1);
    std::size_t smallest = SIZE_MAX;
    std::size_t greatest = 0;
    for (const Options& options : variants) {
        CAPTURE(static_cast<int>(options.matrix), static_cast<int>(options.apply), static_cast<int>(options.execution));
        const OpenClCalls before = opencl_calls();
        std::size_t bytes = 0;
        {
            const StrainLimiter limiter(device().context, device().id, cloth.topology, options);
            bytes = limiter.scratch_bytes();
            CHECK(opencl_calls().allocated_bytes - before.allocated_bytes == bytes);
            CHECK(opencl_calls().builds == before.builds + 1);
        }
        const OpenClCalls after = opencl_calls();
        CHECK(after.allocations > before.allocations);
        CHECK(after.releases - before.releases == after.allocations - before.allocations);
        smallest = std::min(smallest, bytes);
        greatest = std::max(greatest, bytes);
    }
    // A buffer that the options do not need is not made.
    CHECK(smallest < greatest);
}
