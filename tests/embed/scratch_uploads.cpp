// SPDX-License-Identifier: MIT
//
// What a limiter uploads into a caller's scratch memory is there for the first call, whichever queue that is on. Run on
// Intel's OpenCL too, which copies small blocks after a blocking write has returned.
#include "embed/opencl_calls.hpp"
#include "support/device_cloth.hpp"

#include <catch2/catch.hpp>

using namespace apsl;
using namespace apsl::test;

namespace {

/// Two places of one buffer, so that a limiter can be rebuilt from one into the other.
class ScratchMemory {
public:
    explicit ScratchMemory(std::size_t bytes) : half_((bytes + 4095) / 4096 * 4096) {
        cl_int status = CL_SUCCESS;
        memory_ = {clCreateBuffer(device().context, CL_MEM_READ_WRITE, 2 * half_, nullptr, &status),
                   clReleaseMemObject};
        require_success(status, "clCreateBuffer");
    }
    /// Every bit set: indices far outside, floats that are no numbers.
    BufferView poisoned(std::size_t half) const {
        const cl_uint all = 0xFFFFFFFF;
        require_success(clEnqueueFillBuffer(queue_.get(), memory_.get(), &all, sizeof all, half * half_, half_, 0,
                                            nullptr, nullptr),
                        "clEnqueueFillBuffer");
        require_success(clFinish(queue_.get()), "clFinish");
        return {memory_.get(), half * half_};
    }

private:
    std::size_t half_;
    Owned<cl_mem> memory_;
    Owned<cl_command_queue> queue_ = in_order_queue();
};

}  // namespace

TEST_CASE("a call right after each of 200 rebuilds in poisoned scratch memory does what it should",
          "[embed][scratch]") {
    const MovingCloth cloths[] = {moving_cloth(tetrahedron(), 1),
                                  moving_cloth(grid(3, 3, 1.0, 1.0, Diagonals::alternating), 2),
                                  moving_cloth(grid(5, 5, 1.0, 1.0, Diagonals::alternating), 3),
                                  moving_cloth(grid(7, 7, 1.0, 1.0, Diagonals::alternating), 4)};
    const Parameters parameters{.sub_steps = 2};
    for (const Execution execution : {Execution::one_group, Execution::many_groups}) {
        const Options options{.execution = execution};
        std::size_t needed = 0;
        std::vector<std::vector<float>> expected;
        for (const MovingCloth& cloth : cloths) {
            needed =
                std::max(needed, StrainLimiter::required_scratch_bytes(device().id, {&cloth.topology, 1}, options));
            StrainLimiter alone(device().context, device().id, cloth.topology, options);
            const CallerBuffers buffers({&cloth, 1}, options);
            filter(alone, buffers, {&parameters, 1});
            expected.push_back(buffers.read_velocities());
        }
        const ScratchMemory scratch(needed);
        StrainLimiter limiter(device().context, device().id, cloths[0].topology, options, {}, scratch.poisoned(1));
        const Owned<cl_command_queue> queue = in_order_queue();
        for (std::size_t n = 0; n < 100; ++n) {
            const std::size_t c = n % std::size(cloths);
            const CallerBuffers buffers({&cloths[c], 1}, options);
            const BufferView place = scratch.poisoned(n % 2);
            limiter.rebuild(cloths[c].topology, place);
            const cl_event limited = limiter.enqueue(queue.get(), buffers.views(), parameters);
            REQUIRE(wait_and_release(limited) == CL_COMPLETE);
            CAPTURE(n, static_cast<int>(execution));
            REQUIRE(same_bytes(buffers.read_velocities(), expected[c]));
        }
    }
}

TEST_CASE("uploads into scratch memory are waited for, all of them together", "[embed][scratch]") {
    const MovingCloth cloth = moving_cloth(grid(5, 5, 1.0, 1.0, Diagonals::alternating), 1);
    const ScratchMemory scratch(StrainLimiter::required_scratch_bytes(device().id, {&cloth.topology, 1}));
    const BufferView place = scratch.poisoned(0);
    const int waits = opencl_calls().host_waits, queues = opencl_calls().held.queues;
    const StrainLimiter limiter(device().context, device().id, cloth.topology, {}, {}, place);
    CHECK(opencl_calls().host_waits == waits + 1);
    CHECK(opencl_calls().held.queues == queues);
}
