// SPDX-License-Identifier: MIT
#include "embed/opencl_calls.hpp"
#include "embed/variants.hpp"
#include "support/device_cloth.hpp"

#include <catch2/catch.hpp>

using namespace apsl;
using namespace apsl::test;

TEST_CASE("kernels compile without a warning, which a driver may print to the user", "[build]") {
    const MovingCloth cloth = moving_cloth(grid(9, 9, 1.0, 1.0, Diagonals::alternating), 1);
    std::vector<Options> all(std::begin(variants), std::end(variants));
    all.push_back({.execution = Execution::many_groups, .solver = Solver::chebyshev});
    for (const Options& variant : all) {
        const bool by_chebyshev = variant.solver == Solver::chebyshev;
        for (const std::uint32_t work_group_size : {1u, 64u})
            for (const bool positions_only : {false, true})
                for (const bool more : {false, true}) {
                    if (more && by_chebyshev) continue;  // refused
                    Options options = variant;
                    options.work_group_size = work_group_size;
                    options.positions_only = positions_only;
                    options.regularization_per_triangle = more;
                    options.warm_start_sub_steps = more ? 2 : 0;
                    CAPTURE(static_cast<int>(options.matrix), static_cast<int>(options.apply),
                            static_cast<int>(options.execution), by_chebyshev, work_group_size, positions_only, more);
                    const OpenClCalls before = opencl_calls();
                    const StrainLimiter limiter(device().context, device().id, cloth.topology, options);
                    CHECK(opencl_calls().builds == before.builds + 1);
                    CHECK(opencl_calls().warned_builds == before.warned_builds);
                }
    }
}
