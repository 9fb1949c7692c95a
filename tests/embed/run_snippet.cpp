// SPDX-License-Identifier: MIT
#include "embed/snippet.hpp"
#include "support/device_cloth.hpp"

#include <catch2/catch.hpp>

using namespace apsl;
using namespace apsl::test;

TEST_CASE("the README's snippet limits the strain of a cloth", "[embed]") {
    const MovingCloth cloth = moving_cloth(grid(17, 17, 1.0, 1.0, Diagonals::alternating), 1);
    const CallerBuffers buffers({&cloth, 1}, {});
    const Owned<cl_command_queue> queue = in_order_queue();
    const auto triangles = cloth.topology->triangles();
    StrainLimiter limiter = make_limiter(device().context, device().id, {triangles.begin(), triangles.end()},
                                         cloth.topology->vertex_count());

    // How far the areas are off without the filter.
    const Parameters measure_only{.sub_steps = 0};
    const float unfiltered = filter(limiter, buffers, {&measure_only, 1})[0].max_area_change;
    REQUIRE(unfiltered > 0.1f);

    const Stats stats = limit_strain(limiter, queue.get(), buffers.positions.get(), buffers.velocities.get(),
                                     buffers.inverse_masses.get(), buffers.rest_areas.get());
    CHECK(stats.status == Status::ok);
    CHECK(stats.sub_steps == 30);
    CHECK(stats.max_area_change < 0.3f * unfiltered);
}
