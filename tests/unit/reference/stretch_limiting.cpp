// SPDX-License-Identifier: MIT
#include "reference/stretch_limiting.hpp"

#include "chebyshev_products.hpp"
#include "reference/area_change.hpp"
#include "resolved_parameters.hpp"
#include "unit/reference/sample_cloths.hpp"

#include <apsl/error.hpp>
#include <apsl/reference.hpp>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace apsl;
using namespace apsl::reference;

namespace {

constexpr Options limits{.limits_stretch = true};

struct Limited {
    std::vector<double> velocities;
    Stats stats;
};

Limited limited(const test::SampleCloth& cloth, std::vector<double> velocities, const std::vector<double>& shapes,
                const Parameters& parameters) {
    StrainLimiter limiter(cloth.topology, limits);
    limiter.enqueue({.positions = cloth.positions,
                     .velocities = velocities,
                     .inverse_masses = cloth.inverse_masses,
                     .rest_areas = cloth.rest_areas,
                     .regularization = {},
                     .rest_shapes = shapes},
                    parameters);
    return {velocities, limiter.read_stats()};
}

std::vector<double> shapes_of(const test::SampleCloth& cloth) {
    return rest_shapes<double>(*cloth.topology, cloth.positions);
}

/// A velocity that draws a cloth out along x by `rate` in a step, and shakes it.
std::vector<double> drawing(const test::SampleCloth& cloth, double rate, double time_step) {
    std::vector<double> velocities(cloth.positions.size());
    for (std::size_t n = 0; n < velocities.size(); ++n)
        velocities[n] =
            (n % 3 == 0 ? rate * cloth.positions[n] : 0.01 * std::sin(17.0 * static_cast<double>(n))) / time_step;
    return velocities;
}

/// What decides which state stands, at the end of a step.
struct Judged {
    double areas;  ///< RMS of their change
    double both;   ///< capped RMS of the change and of the excess
};

Judged judged(const test::SampleCloth& cloth, const std::vector<double>& shapes, const std::vector<double>& velocities,
              const Parameters& parameters) {
    std::vector<double> end = cloth.positions;
    for (std::size_t n = 0; n < end.size(); ++n) end[n] += static_cast<double>(parameters.time_step) * velocities[n];
    std::vector<TriangleGeometry<double>> geometry;
    triangle_geometries<double>(*cloth.topology, end, geometry);
    StretchLimiting<double> stretches;
    std::vector<double> unused = velocities;
    stretches.start(*cloth.topology, {cloth.positions, unused, cloth.inverse_masses, cloth.rest_areas, {}, shapes, {}},
                    static_cast<double>(parameters.stretch_ceiling));
    const AreaChange areas = area_change<double>(geometry, cloth.rest_areas);
    return {areas.rms, std::hypot(areas.capped_rms, stretches.measure(end).capped_rms)};
}

}  // namespace

TEST_CASE("stretch ceiling: rest shapes of right triangles, by hand", "[stretch_limiting]") {
    const auto topology = Topology::build(std::vector<Triangle>{{0, 1, 2}, {1, 0, 2}, {0, 1, 3}}, 4);
    const std::vector<double> positions{0, 0, 0, 2, 0, 0, 0, 0, 4, 1, 0, 0};
    CHECK(rest_shapes<double>(*topology, positions) ==
          std::vector<double>{0.5, 0, 0, 0.25, 0.5, -0.25, 0, 0.25, 0, 0, 0, 0});
}

TEST_CASE("stretch ceiling: what is led back, and how long the polynomial is", "[stretch_limiting]") {
    CHECK(start_error_left(0, 30, true) == Approx(0.9));
    CHECK(start_error_left(9, 30, true) == 0.0f);
    CHECK(start_error_left(0, 2, true) == 0.0f);
    CHECK(chebyshev_products(1.05, 50, true) == 11);  // √144
    CHECK(chebyshev_products(1.05, 7, true) == 7);
    CHECK(ResolvedParameters({.sub_steps = 2}, limits).small_steps == 1);
    CHECK(ResolvedParameters({.sub_steps = 2}, limits).raises_masses);
    CHECK(ResolvedParameters({.sub_steps = 1}, limits).small_steps == 0);
}

TEST_CASE("stretch ceiling: a sheet drawn out to 1.4 comes back to its ceiling, with its areas", "[stretch_limiting]") {
    test::SampleCloth sheet = test::grid_cloth(9, 9, test::Diagonals::alternating);
    const std::vector<double> shapes = shapes_of(sheet);
    for (const float ceiling : {1.05f, 1.1f, 1.25f}) {
        CAPTURE(ceiling);
        const Parameters parameters{.stretch_ceiling = ceiling};
        const Limited got = limited(sheet, drawing(sheet, 0.4, 1.0 / 60.0), shapes, parameters);
        CHECK(got.stats.status == Status::ok);
        CHECK(got.stats.initial_max_stretch_excess > 0.1f);
        CHECK(got.stats.max_stretch < ceiling + 0.02f);
        CHECK(got.stats.max_stretch_excess == Approx(std::max(0.0f, got.stats.max_stretch - ceiling)).margin(1e-6));
        CHECK(got.stats.rms_stretch_excess <= got.stats.max_stretch_excess);
        CHECK(got.stats.max_area_change < 0.05f);
        CHECK(got.stats.stretch_rows > 0);
        CHECK(got.stats.raised_vertices > 0);
    }
}

TEST_CASE("stretch ceiling: without a ceiling or a shape no row of stretch is at work", "[stretch_limiting]") {
    const test::SampleCloth sheet = test::grid_cloth(5, 5, test::Diagonals::uniform);
    const std::vector<double> shapes = shapes_of(sheet), none(shapes.size(), 0.0);
    const auto stats_of = [&](const std::vector<double>& given, float ceiling) {
        return limited(sheet, drawing(sheet, 0.4, 1.0 / 60.0), given, {.stretch_ceiling = ceiling}).stats;
    };
    for (const Stats& stats : {stats_of(shapes, 0.0f), stats_of(none, 1.1f)}) {
        CHECK(stats.max_stretch == 0.0f);
        CHECK(stats.stretch_rows == 0);
        CHECK(stats.max_area_change < 0.05f);
    }
}

TEST_CASE("stretch ceiling: one sub-step moves no centre of mass", "[stretch_limiting]") {
    test::SampleCloth sheet = test::grid_cloth(7, 5, test::Diagonals::random);
    const std::vector<double> velocities = drawing(sheet, 0.3, 1.0 / 60.0);
    const Limited got = limited(sheet, velocities, shapes_of(sheet), {.sub_steps = 1, .stretch_ceiling = 1.05f});
    CHECK(got.stats.max_stretch_excess < got.stats.initial_max_stretch_excess);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double momentum = 0.0, size = 0.0;
        for (std::size_t v = 0; v < sheet.inverse_masses.size(); ++v) {
            const double change = (got.velocities[3 * v + axis] - velocities[3 * v + axis]) / sheet.inverse_masses[v];
            momentum += change;
            size += std::abs(change);
        }
        CHECK(std::abs(momentum) <= 1e-12 * (size + 1e-12));
    }
}

TEST_CASE("stretch ceiling: of the two ends of a call the one with less stands", "[stretch_limiting]") {
    std::size_t limited_calls = 0;
    for (const test::SampleCloth& cloth : test::wavy_cloths())
        for (const double rate : {-0.5, 0.1, 0.5, 3.0})
            for (const int sub_steps : {1, 3, 30}) {
                CAPTURE(cloth.name, rate, sub_steps);
                const Parameters parameters{.sub_steps = sub_steps, .stretch_ceiling = 1.1f};
                const std::vector<double> shapes = shapes_of(cloth);
                const std::vector<double> velocities = drawing(cloth, rate, 1.0 / 60.0);
                const Limited got = limited(cloth, velocities, shapes, parameters);
                for (const double v : got.velocities) CHECK(std::isfinite(v));
                limited_calls += got.velocities != velocities ? 1 : 0;
                const Judged before = judged(cloth, shapes, velocities, parameters);
                const Judged after = judged(cloth, shapes, got.velocities, parameters);
                CHECK(after.both <= (after.areas < before.areas ? 1.5 : 1.0) * before.both + 1e-6);
            }
    CHECK(limited_calls > 50);
}

TEST_CASE("stretch ceiling: sizes and values that do not fit are refused", "[stretch_limiting]") {
    const test::SampleCloth sheet = test::grid_cloth(3, 3, test::Diagonals::uniform);
    const std::vector<double> shapes = shapes_of(sheet);
    const std::vector<double> still(sheet.positions.size(), 0.0);
    const auto message = [&](std::vector<double> given, const Parameters& parameters) {
        try {
            limited(sheet, still, given, parameters);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("taken");
    };
    CHECK(message(shapes, {.stretch_ceiling = 1.1f}) == "taken");
    CHECK(message({1.0, 0.0}, {}) == "rest_shapes holds 2 numbers, expected 32");
    CHECK(message(shapes, {.stretch_ceiling = 1.0f}) ==
          "stretch_ceiling is 1, expected 0 (areas alone) or a finite number >= 1.01");
    std::vector<double> bad = shapes;
    bad[5] = std::numeric_limits<double>::quiet_NaN();
    CHECK(message(bad, {}).find("rest_shapes of number 5 is ") == 0);
    StrainLimiter areas_alone(sheet.topology);
    std::vector<double> velocities = still;
    CHECK_THROWS_AS(areas_alone.enqueue({sheet.positions, velocities, sheet.inverse_masses, sheet.rest_areas, {}},
                                        {.stretch_ceiling = 1.1f}),
                    Error);
}
