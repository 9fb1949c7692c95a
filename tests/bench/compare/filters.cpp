// SPDX-License-Identifier: MIT
#include "compare/baseline_filter.hpp"
#include "compare/direct_filter.hpp"
#include "compare/integrating_step.hpp"
#include "pipeline/measures.hpp"
#include "run/reference_filter.hpp"

#include <apsl/error.hpp>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace apsl;
using namespace apsl::compare;

namespace {

// A square of two triangles in the air, its first vertex pinned, torn apart along x.
scenes::ClothState square() {
    const std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
    const std::vector<double> rest{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    const std::array<std::uint32_t, 1> pinned{0};
    scenes::ClothState cloth = scenes::make_cloth_state(Topology::build(triangles, 4), rest, 0.2, pinned);
    cloth.velocities[3] = 2.0;
    cloth.velocities[6] = 2.0;
    return cloth;
}

double greatest_area_change(const scenes::ClothState& cloth, double time_step) {
    return scenes::summarize(cloth, scenes::predicted_area_changes(cloth, time_step)).max;
}

}  // namespace

TEST_CASE("a baseline's displacement goes into the velocities of free vertices") {
    const methods::MethodInfo& baseline = methods::all_methods()[0];
    scenes::ClothState cloth = square();
    const scenes::ClothState before = cloth;
    const scenes::CustomFilter filter = make_baseline_filter(baseline, {}, cloth, 0.1);
    CHECK(filter.name == baseline.name);
    CHECK(filter.filter(cloth).status == Status::ok);
    CHECK(greatest_area_change(cloth, 0.1) < greatest_area_change(before, 0.1));
    CHECK(cloth.positions == before.positions);
    CHECK(cloth.velocities[0] == 0.0);
}

TEST_CASE("a baseline is left out where numbers are not finite") {
    scenes::ClothState cloth = square();
    cloth.velocities[3] = std::numeric_limits<double>::infinity();
    const scenes::ClothState before = cloth;
    const scenes::CustomFilter filter = make_baseline_filter(methods::all_methods()[0], {}, cloth, 0.1);
    CHECK(filter.filter(cloth).status == Status::diverged);
    CHECK(cloth.velocities == before.velocities);
}

TEST_CASE("a step of tethers moves positions and velocities of free vertices") {
    scenes::ClothState cloth = square();
    cloth.velocities[1] = 0.25;  // of the pinned vertex
    const scenes::ClothState before = cloth;
    const methods::TetherSettings settings{.steps = 20, .damping = 0.0, .gravity = Eigen::Vector3d::Zero()};
    const scenes::CustomStep step = make_tethers_step(settings, cloth, 0.1);
    CHECK(step.step(cloth).status == Status::ok);
    CHECK(cloth.positions[1] == 0.1 * 0.25);
    CHECK(cloth.velocities[1] == 0.25);
    CHECK(cloth.positions[3] != before.positions[3]);
    CHECK(scenes::edge_stretch(cloth).max < 1.05);  // torn apart it would be 1.2
    CHECK(cloth.velocities[3] < before.velocities[3]);
}

TEST_CASE("a step of tethers is left out where numbers are not finite") {
    scenes::ClothState cloth = square();
    cloth.velocities[3] = std::numeric_limits<double>::quiet_NaN();
    const std::vector<double> before = cloth.positions;
    CHECK(make_tethers_step({}, cloth, 0.1).step(cloth).status == Status::diverged);
    CHECK(cloth.positions == before);
}

TEST_CASE("a baseline in small steps moves positions and velocities of free vertices") {
    const auto all = methods::all_methods();
    const auto found =
        std::find_if(all.begin(), all.end(), [](const auto& method) { return method.name == "pbd_edges"; });
    REQUIRE(found != all.end());
    scenes::ClothState cloth = square();
    cloth.velocities[1] = 0.25;  // of the pinned vertex
    const scenes::ClothState before = cloth;
    const methods::Parameter once{"iterations", 1.0};
    const scenes::CustomStep step = make_baseline_step(*found, {&once, 1}, {.count = 20}, cloth, 0.1);
    CHECK(step.step(cloth).status == Status::ok);
    CHECK(cloth.positions[1] == 0.1 * 0.25);
    CHECK(cloth.velocities[1] == 0.25);
    CHECK(scenes::edge_stretch(cloth).max < 1.05);  // torn apart it would be 1.2
    CHECK(cloth.velocities[3] < before.velocities[3]);
    cloth.velocities[3] = std::numeric_limits<double>::quiet_NaN();
    const std::vector<double> stands = cloth.positions;
    CHECK(step.step(cloth).status == Status::diverged);
    CHECK(cloth.positions == stands);
    CHECK_THROWS_AS(make_baseline_step(*found, {}, {.count = 0}, cloth, 0.1), Error);
}

TEST_CASE("small steps fall freely, whatever their number") {
    const methods::MethodInfo& method = methods::all_methods()[0];
    for (const int count : {1, 10, 100}) {
        scenes::ClothState cloth = square();
        for (double& w : cloth.inverse_masses) w = 1.0;
        std::fill(cloth.velocities.begin(), cloth.velocities.end(), 0.0);
        const scenes::ClothState before = cloth;
        const SmallSteps steps{.count = count, .damping = 0.0, .gravity = {0.0, -10.0, 0.0}};
        REQUIRE(make_baseline_step(method, {}, steps, cloth, 0.1).step(cloth).status == Status::ok);
        CHECK(cloth.velocities[4] == Approx(-1.0).epsilon(1e-3));
        CHECK(cloth.positions[4] - before.positions[4] == Approx(-0.05 * (count + 1) / count).epsilon(1e-4));
    }
}

TEST_CASE("direct solves end where tight Conjugate Gradient ends") {
    scenes::StrainLimiting settings;
    settings.parameters = {.time_step = 0.1f, .regularization = 1.05f, .sub_steps = 4, .tolerance = 1e-12f};
    scenes::ClothState direct = square();
    scenes::ClothState iterated = square();
    CHECK(make_direct_filter(direct, settings).filter(direct).sub_steps == 4);
    scenes::ReferenceFilter(iterated, settings).filter(iterated);
    CHECK(direct.velocities != square().velocities);
    for (std::size_t i = 0; i < direct.velocities.size(); ++i)
        CHECK(direct.velocities[i] == Approx(iterated.velocities[i]).margin(1e-9));
}

TEST_CASE("direct solves stop at the target and say what is not finite") {
    scenes::StrainLimiting settings;
    settings.parameters = {.time_step = 0.1f, .sub_steps = 4, .target_area_change = 10.0f};
    scenes::ClothState cloth = square();
    CHECK(make_direct_filter(cloth, settings).filter(cloth).sub_steps == 0);
    CHECK(cloth.velocities == square().velocities);
    cloth.velocities[4] = std::numeric_limits<double>::quiet_NaN();
    CHECK(make_direct_filter(cloth, settings).filter(cloth).status == Status::diverged);
}
