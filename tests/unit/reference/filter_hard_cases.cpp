// SPDX-License-Identifier: MIT
//
// Where the method has no answer it must do nothing, say so, and stay finite.

#include "unit/reference/run_filter.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>

using namespace apsl;
using namespace apsl::reference;
using test::run_filter;
using test::velocities_towards;

namespace {

bool all_finite(const std::vector<double>& numbers) {
    for (const double number : numbers)
        if (!std::isfinite(number)) return false;
    return true;
}

bool same_bits(const std::vector<double>& one, const std::vector<double>& other) {
    return one.size() == other.size() && std::memcmp(one.data(), other.data(), one.size() * sizeof(double)) == 0;
}

test::SampleCloth triangle_cloth(std::vector<double> positions, std::vector<double> inverse_masses) {
    return {"",
            Topology::build(test::right_triangle().triangles, 3),
            std::move(positions),
            std::move(inverse_masses),
            {1.0}};
}

/// Velocities that stretch a cloth by a tenth, and bend it.
std::vector<double> stretching(const test::SampleCloth& cloth) {
    std::vector<double> target = test::wavy(cloth.positions, 0.05);
    for (double& coordinate : target) coordinate *= 1.1;
    return velocities_towards(cloth, target, Parameters{}.time_step);
}

}  // namespace

TEST_CASE("a triangle with three pinned vertices is left alone") {
    const auto cloth = triangle_cloth({0, 0, 0, 3, 0, 0, 0, 1, 0}, {0, 0, 0});
    const std::vector<double> velocities{1, 2, 3, 4, 5, 6, 7, 8, 9};
    for (const float alpha : {1.0f, 1.2f})
        for (const Matrix matrix : {Matrix::consistent, Matrix::printed}) {
            const auto filtered = run_filter<double>(cloth, velocities, {.regularization = alpha}, matrix);
            CHECK(same_bits(filtered.velocities, velocities));
            CHECK(filtered.stats.status == Status::ok);
            CHECK(filtered.stats.iterations == 0);
            CHECK(filtered.stats.max_area_change > 0.0f);
        }
}

TEST_CASE("triangles without area get no pressure and no NaN") {
    const std::vector<double> still(9, 0.0);
    for (const std::vector<double>& positions :
         {std::vector<double>{1, 1, 1, 1, 1, 1, 1, 1, 1}, std::vector<double>{0, 0, 0, 1, 0, 0, 2, 0, 0}}) {
        const auto filtered = run_filter<double>(triangle_cloth(positions, {1, 1, 1}), still, {});
        CHECK(same_bits(filtered.velocities, still));
        CHECK(filtered.stats.status == Status::ok);
        CHECK(filtered.stats.max_area_change == 1.0f);
    }
}

TEST_CASE("needles stay finite") {
    const std::vector<double> still(9, 0.0);
    for (const double height : {1e-3, 1e-9, 1e-15, 1e-150}) {
        CAPTURE(height);
        const auto cloth = triangle_cloth({0, 0, 0, 1, 0, 0, 0.5, height, 0}, {1, 2, 3});
        for (const Matrix matrix : {Matrix::consistent, Matrix::printed}) {
            const auto filtered = run_filter<double>(cloth, still, {}, matrix);
            CHECK(all_finite(filtered.velocities));
            CHECK(filtered.stats.status == Status::ok);
            const auto in_float = run_filter<float>(cloth, still, {}, matrix);
            CHECK(std::isfinite(in_float.stats.max_area_change));
        }
    }
}

TEST_CASE("a collapsed triangle in a cloth does not disturb the rest of it") {
    auto cloth = test::grid_cloth(9, 9, test::Diagonals::alternating);
    const Triangle& collapsed = cloth.topology->triangles()[60];
    for (std::size_t axis = 0; axis < 3; ++axis)
        cloth.positions[3 * collapsed[1] + axis] = cloth.positions[3 * collapsed[0] + axis];
    const std::vector<double> still(cloth.positions.size(), 0.0);
    const double before = run_filter<double>(cloth, still, {.sub_steps = 0}).stats.rms_area_change;
    const auto filtered = run_filter<double>(cloth, still, {});
    CHECK(all_finite(filtered.velocities));
    CHECK(filtered.stats.status == Status::ok);
    CHECK(filtered.stats.rms_area_change < before);
}

TEST_CASE("any topology is filtered: boundaries, folds, books, fans, duplicates, parts, lone vertices") {
    for (const auto& wavy : test::wavy_cloths()) {
        test::SampleCloth cloth = wavy;
        cloth.rest_areas = areas<double>(*cloth.topology, cloth.positions);
        INFO(cloth.name);
        const auto velocities = stretching(cloth);
        const auto before = run_filter<double>(cloth, velocities, {.sub_steps = 0}).stats;
        const auto filtered = run_filter<double>(cloth, velocities, {});
        CHECK(all_finite(filtered.velocities));
        CHECK(filtered.stats.status == Status::ok);
        CHECK(filtered.stats.rms_area_change < before.rms_area_change);
    }
}

TEST_CASE("vertices in no triangle keep their velocity") {
    const test::Mesh mesh = test::right_triangle();
    test::SampleCloth cloth{"", Topology::build(mesh.triangles, 4), mesh.positions, {1, 1, 1, 1}, {0.5}};
    cloth.positions.insert(cloth.positions.end(), {5, 6, 7});
    const std::vector<double> velocities{0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3};
    const auto filtered = run_filter<double>(cloth, velocities, {});
    CHECK(std::memcmp(&filtered.velocities[9], &velocities[9], 3 * sizeof(double)) == 0);
    CHECK(filtered.stats.max_area_change < 0.1f);
}

TEST_CASE("alpha = 1 and alpha = 10^6 both run") {
    auto cloth = test::grid_cloth(17, 17, test::Diagonals::alternating);
    cloth.inverse_masses[0] = cloth.inverse_masses[16] = 0.0;
    const auto velocities = stretching(cloth);
    const double before = run_filter<double>(cloth, velocities, {.sub_steps = 0}).stats.rms_area_change;

    const auto tight = run_filter<double>(cloth, velocities, {.regularization = 1.0f});
    CHECK(all_finite(tight.velocities));
    CHECK(tight.stats.status != Status::diverged);
    CHECK(tight.stats.rms_area_change < 0.2 * before);
    CHECK(run_filter<float>(cloth, velocities, {.regularization = 1.0f}).stats.rms_area_change < 0.2 * before);

    const auto loose = run_filter<double>(cloth, velocities, {.regularization = 1e6f});
    CHECK(loose.stats.status == Status::ok);
    CHECK(loose.stats.rms_area_change == Approx(before).epsilon(1e-3));
    CHECK_FALSE(same_bits(loose.velocities, velocities));
}

TEST_CASE("a solve cut short is told, and what it reached stands") {
    auto cloth = test::grid_cloth(17, 17, test::Diagonals::alternating);
    const auto velocities = stretching(cloth);
    const double before = run_filter<double>(cloth, velocities, {.sub_steps = 0}).stats.rms_area_change;
    const auto filtered =
        run_filter<double>(cloth, velocities, {.sub_steps = 4, .tolerance = 1e-6f, .max_iterations = 2});
    CHECK(filtered.stats.status == Status::not_converged);
    CHECK(filtered.stats.iterations == 8);
    CHECK(filtered.stats.residual > 1e-6f);
    CHECK(filtered.stats.rms_area_change < before);
}

TEST_CASE("input that is not finite is a status, and the velocities stay as they were") {
    const auto cloth = test::grid_cloth(5, 5, test::Diagonals::random);
    const auto velocities = stretching(cloth);
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
        auto bad_velocities = velocities;
        bad_velocities[7] = bad;
        auto bad_cloth = cloth;
        bad_cloth.positions[40] = bad;
        for (const Matrix matrix : {Matrix::consistent, Matrix::printed}) {
            const auto from_velocity = run_filter<double>(cloth, bad_velocities, {}, matrix);
            CHECK(from_velocity.stats.status == Status::diverged);
            CHECK(same_bits(from_velocity.velocities, bad_velocities));
            const auto from_position = run_filter<double>(bad_cloth, velocities, {}, matrix);
            CHECK(from_position.stats.status == Status::diverged);
            CHECK(same_bits(from_position.velocities, velocities));
            for (const Stats& stats : {from_velocity.stats, from_position.stats}) {
                CHECK(std::isfinite(stats.residual));
                CHECK(std::isfinite(stats.max_area_change));
                CHECK(std::isfinite(stats.rms_area_change));
            }
        }
    }
}

TEST_CASE("a call after a diverged one starts anew") {
    const auto cloth = test::grid_cloth(5, 5, test::Diagonals::random);
    const auto good = stretching(cloth);
    reference::StrainLimiter limiter(cloth.topology);
    auto velocities = good;
    velocities[0] = std::numeric_limits<double>::quiet_NaN();
    limiter.enqueue({cloth.positions, velocities, cloth.inverse_masses, cloth.rest_areas, {}}, {});
    CHECK(limiter.read_stats().status == Status::diverged);
    velocities = good;
    limiter.enqueue({cloth.positions, velocities, cloth.inverse_masses, cloth.rest_areas, {}}, {});
    CHECK(limiter.read_stats().status == Status::ok);
    CHECK(same_bits(velocities, run_filter<double>(cloth, good, {}).velocities));
}
