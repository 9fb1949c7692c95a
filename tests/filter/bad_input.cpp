// SPDX-License-Identifier: MIT
//
// Numbers no cloth should have: never a NaN handed on.
#include "filter/filtered.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace apsl;
using namespace apsl::test;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The call ends as diverged, and the velocities have the bytes they were given with.
void check_diverged(const MovingCloth& cloth, const Options& options) {
    StrainLimiter limiter(device().context, device().id, cloth.topology, options);
    const CallerBuffers buffers({&cloth, 1}, options), given({&cloth, 1}, options);
    const Parameters parameters{.sub_steps = 2};
    const std::vector<Stats> stats = filter(limiter, buffers, {&parameters, 1});
    CHECK(stats[0].status == Status::diverged);
    CHECK(same_bytes(buffers.read_velocities(), given.read_velocities()));
}

void check_finite(const MovingCloth& cloth, const Options& options) {
    Parameters parameters;
    if (options.matrix == Matrix::printed) parameters.regularization = 2.0f;  // below it diverges on sane input too
    const Filtered filtered = filter_on_device(cloth, options, parameters);
    CHECK(filtered.stats.status != Status::diverged);
    CHECK(all_finite(filtered.velocities));
    CHECK(std::isfinite(filtered.stats.max_area_change));
    CHECK(std::isfinite(filtered.stats.rms_area_change));
    CHECK(std::isfinite(filtered.stats.residual));
}

MovingCloth a_cloth() {
    return moving_cloth(grid(9, 9, 1.0, 1.0, Diagonals::alternating), 1);
}

}  // namespace

TEST_CASE("input that is not finite is diverged, and the velocities stay", "[filter]") {
    for (const Options& options : variants)
        for (const double bad : {not_a_number, infinity, -infinity, 1e38}) {
            CAPTURE(variant_name(options), bad);
            MovingCloth positions = a_cloth();
            positions.positions[100] = bad;
            check_diverged(positions, options);
            MovingCloth velocities = a_cloth();
            velocities.velocities[100] = bad;
            check_diverged(velocities, options);
            if (std::isfinite(bad) || bad < 0.0) continue;
            MovingCloth masses = a_cloth();
            masses.inverse_masses[30] = bad;
            check_diverged(masses, options);
            MovingCloth rest_areas = a_cloth();
            rest_areas.rest_areas[30] = bad;
            check_diverged(rest_areas, options);
        }
}

TEST_CASE("what breaks a call is named, and the next call works like a fresh limiter's", "[filter]") {
    struct Fault {
        const char* what;
        std::vector<double> MovingCloth::* array;
        std::size_t index;
        double value;
        Offender offender;
        std::uint32_t offender_index;
    };
    const std::vector<Fault> faults{
        {"position", &MovingCloth::positions, 100, not_a_number, Offender::vertex, 33},
        {"velocity", &MovingCloth::velocities, 101, infinity, Offender::vertex, 33},
        {"inverse mass", &MovingCloth::inverse_masses, 40, not_a_number, Offender::vertex, 40},
        {"negative inverse mass", &MovingCloth::inverse_masses, 40, -1.0, Offender::vertex, 40},
        {"rest area", &MovingCloth::rest_areas, 30, not_a_number, Offender::triangle, 30},
        {"negative rest area", &MovingCloth::rest_areas, 30, -1.0, Offender::triangle, 30},
        {"area that overflows", &MovingCloth::positions, 100, 1e25, Offender::triangle,
         a_cloth().topology->corners()[a_cloth().topology->corner_offsets()[33]] / 3},
    };
    const MovingCloth sane = a_cloth();
    for (const Options& options : variants)
        for (const Fault& fault : faults) {
            CAPTURE(variant_name(options), fault.what);
            StrainLimiter limiter(device().context, device().id, sane.topology, options);
            MovingCloth broken = a_cloth();
            (broken.*fault.array)[fault.index] = fault.value;
            const CallerBuffers buffers({&broken, 1}, options), given({&broken, 1}, options);
            const Parameters parameters{.sub_steps = 3};
            const Stats stats = filter(limiter, buffers, {&parameters, 1})[0];
            CHECK(stats.status == Status::diverged);
            CHECK(stats.offender == fault.offender);
            CHECK(stats.offender_index == fault.offender_index);
            CHECK(same_bytes(buffers.read_velocities(), given.read_velocities()));

            StrainLimiter fresh(device().context, device().id, sane.topology, options);
            const CallerBuffers after({&sane, 1}, options), expected({&sane, 1}, options);
            const Stats next = filter(limiter, after, {&parameters, 1})[0];
            filter(fresh, expected, {&parameters, 1});
            CHECK(next.status != Status::diverged);
            CHECK(next.offender == Offender::none);
            CHECK(same_bytes(after.read_velocities(), expected.read_velocities()));
        }
}

TEST_CASE("an isolated vertex that is not finite is named too", "[filter]") {
    Mesh mesh = grid(5, 5, 1.0, 1.0, Diagonals::alternating);
    mesh.positions.insert(mesh.positions.end(), {0.0, 0.0, 0.0});
    MovingCloth cloth = moving_cloth(mesh, 1);
    cloth.positions[75] = infinity;
    cloth.inverse_masses[25] = 1.0;
    const Filtered filtered = filter_on_device(cloth, {}, Parameters{});
    CHECK(filtered.stats.status == Status::diverged);
    CHECK(filtered.stats.offender == Offender::vertex);
    CHECK(filtered.stats.offender_index == 25);
    CHECK(filtered.velocities == cloth.velocities);
}

TEST_CASE("triangles without area, wholly pinned, or without rest area take no part and harm nobody", "[filter]") {
    for (const Options& options : variants) {
        CAPTURE(variant_name(options));
        MovingCloth degenerate = a_cloth();
        for (const std::size_t v : {30, 31, 32})
            for (std::size_t k = 0; k < 3; ++k) {
                degenerate.positions[3 * v + k] = degenerate.positions[90 + k];
                degenerate.velocities[3 * v + k] = degenerate.velocities[90 + k];
            }
        check_finite(degenerate, options);

        MovingCloth pinned = a_cloth();
        for (const std::uint32_t v : pinned.topology->triangles()[50]) pinned.inverse_masses[v] = 0.0;
        check_finite(pinned, options);

        MovingCloth all_pinned = a_cloth();
        all_pinned.inverse_masses.assign(all_pinned.inverse_masses.size(), 0.0);
        check_finite(all_pinned, options);
        CHECK(filter_on_device(all_pinned, options, Parameters{}).velocities == all_pinned.velocities);

        MovingCloth no_rest_area = a_cloth();
        no_rest_area.rest_areas[12] = 0.0;
        check_finite(no_rest_area, options);
    }
}

TEST_CASE("all vertices in one point, and a collapsed line", "[filter]") {
    for (const Options& options : variants) {
        MovingCloth point = a_cloth();
        point.positions.assign(point.positions.size(), 0.25);
        point.velocities.assign(point.velocities.size(), 0.0);
        check_finite(point, options);
        MovingCloth line = a_cloth();
        for (std::size_t n = 0; n < line.positions.size(); ++n)
            if (n % 3 != 0) line.positions[n] = line.velocities[n] = 0.0;
        check_finite(line, options);
    }
}

TEST_CASE("alpha per triangle that is not a number >= 1 hands nothing broken on", "[filter]") {
    for (const Options& variant : variants) {
        Options options = variant;
        options.regularization_per_triangle = true;
        for (const double bad : {not_a_number, infinity, 0.0, -3.0}) {
            CAPTURE(bad);
            MovingCloth cloth = a_cloth();
            cloth.regularization[7] = bad;
            CHECK(all_finite(filter_on_device(cloth, options, Parameters{}).velocities));
        }
    }
}

TEST_CASE("ten kilometres from the origin the result is coarse but finite", "[filter]") {
    for (const Options& options : variants) {
        MovingCloth cloth = a_cloth();
        for (std::size_t n = 0; n < cloth.positions.size(); ++n)
            cloth.positions[n] = static_cast<float>(cloth.positions[n] + 1e4);
        check_finite(cloth, options);
    }
}

TEST_CASE("extreme masses and time steps stay finite", "[filter]") {
    for (const Options& options : variants) {
        MovingCloth cloth = a_cloth();
        for (std::size_t v = 0; v < cloth.inverse_masses.size(); v += 3) cloth.inverse_masses[v] *= 1e6;
        check_finite(cloth, options);
        for (const float time_step : {1e-6f, 1.0f}) {
            CAPTURE(time_step);
            const Filtered filtered = filter_on_device(a_cloth(), options, {.time_step = time_step});
            CHECK(all_finite(filtered.velocities));
        }
    }
}
