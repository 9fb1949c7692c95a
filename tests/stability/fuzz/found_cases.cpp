// SPDX-License-Identifier: MIT
//
// The smallest cases of what random cases once broke.
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

TEST_CASE("without a sub-step velocities keep every bit", "[fuzz]") {
    MovingCloth cloth = one_triangle();
    cloth.velocities.assign(9, -0.0);
    const Filtered filtered = filter_on_device(cloth, many_groups, {.target_area_change = 10.0f});
    REQUIRE(filtered.stats.sub_steps == 0);
    for (const double velocity : filtered.velocities) CHECK(std::signbit(velocity));
}

TEST_CASE("area changes that overflow end as diverged, or with statistics that are finite", "[fuzz]") {
    MovingCloth cloth = one_triangle();
    cloth.rest_areas = {static_cast<double>(1e-25f)};  // the change, 1e25, has no square in 32 bits
    const Filtered filtered = filter_on_device(cloth, many_groups, {.sub_steps = 0});
    CHECK((filtered.stats.status == Status::diverged || std::isfinite(filtered.stats.rms_area_change)));
}

TEST_CASE("tolerance 0: the reference ends with what it reached, not with 0/0", "[fuzz]") {
    const auto numbers = [](std::initializer_list<float> list) {
        return std::vector<double>(list.begin(), list.end());
    };
    MovingCloth cloth;
    const std::vector<Triangle> triangles{{0, 1, 2}, {0, 1, 3}};
    cloth.topology = Topology::build(triangles, 4);
    cloth.positions = numbers({999.999878f, 1000.00006f, 1000.00006f, 999.999756f, 1000.00024f, 1000.01001f,
                               1000.01019f, 1000.00012f, 1000.00476f, 999.989929f, 1000.00018f, 1000.00488f});
    cloth.velocities =
        numbers({-0.320218384f, 0.337294281f, -0.543079495f, 0.188819155f, 0.0702051073f, -0.436275721f, -0.162103713f,
                 -0.0190634187f, -0.3857283f, -0.443664461f, -0.292443216f, -0.538051426f});
    cloth.inverse_masses = numbers({149781.547f, 0.0f, 0.0f, 306901.344f});
    cloth.rest_areas = numbers({5.12702063e-05f, 4.88756377e-05f});
    const Parameters parameters{
        .time_step = 0.1f, .regularization = 1.2f, .sub_steps = 1, .tolerance = 0.0f, .max_iterations = 50};
    CHECK(filter_with_reference(cloth, {}, parameters).stats.status != Status::diverged);
}
