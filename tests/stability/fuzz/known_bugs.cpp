// SPDX-License-Identifier: MIT
//
// The smallest cases of bugs in known_bugs.hpp: each fails today, and the test program says so when one no longer does.
#include "filter/filtered.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;

namespace {

MovingCloth one_triangle() {
    MovingCloth cloth = moving_cloth(right_triangle(), 1);
    cloth.positions = right_triangle().positions;
    cloth.velocities.assign(9, 0.0);
    cloth.inverse_masses.assign(3, 1.0);
    cloth.rest_areas = {1.0};
    return cloth;
}

}  // namespace

TEST_CASE("without a sub-step velocities keep every bit", "[fuzz][!shouldfail]") {
    MovingCloth cloth = one_triangle();
    cloth.velocities.assign(9, -0.0);
    const Filtered filtered = filter_on_device(cloth, many_groups, {.target_area_change = 10.0f});
    REQUIRE(filtered.stats.sub_steps == 0);
    for (const double velocity : filtered.velocities) CHECK(std::signbit(velocity));
}

TEST_CASE("area changes that overflow end as diverged, or with statistics that are finite", "[fuzz][!shouldfail]") {
    MovingCloth cloth = one_triangle();
    cloth.rest_areas = {static_cast<double>(1e-25f)};  // the change, 1e25, has no square in 32 bits
    const Filtered filtered = filter_on_device(cloth, many_groups, {.sub_steps = 0});
    CHECK((filtered.stats.status == Status::diverged || std::isfinite(filtered.stats.rms_area_change)));
}
