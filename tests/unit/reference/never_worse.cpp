// SPDX-License-Identifier: MIT
#include "unit/reference/run_filter.hpp"
#include "unit/reference/sample_cloths.hpp"

#include <apsl/reference.hpp>

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;

namespace {

struct Change {
    double max = 0.0, rms = 0.0, capped_rms = 0.0;
    std::size_t worst = 0;
};

// At the end of the step, weighted with rest areas.
Change change_after(const SampleCloth& cloth, const std::vector<double>& velocities, double time_step) {
    const std::vector<double> areas =
        reference::areas<double>(*cloth.topology, positions_after(cloth, velocities, time_step));
    double max = 0.0, squares = 0.0, capped_squares = 0.0, weights = 0.0;
    std::size_t worst = 0;
    for (std::size_t a = 0; a < areas.size(); ++a) {
        const double change = std::abs(areas[a] - cloth.rest_areas[a]) / cloth.rest_areas[a];
        if (change > max) worst = a;
        max = std::max(max, change);
        squares += cloth.rest_areas[a] * change * change;
        capped_squares += cloth.rest_areas[a] * std::min(change, 1.0) * std::min(change, 1.0);
        weights += cloth.rest_areas[a];
    }
    return {max, std::sqrt(squares / weights), std::sqrt(capped_squares / weights), worst};
}

}  // namespace

TEST_CASE("never worse: greatest and RMS area change, or the status says so and the better state stands") {
    int rose = 0, dropped = 0, fell = 0;
    for (const SampleCloth& cloth : wavy_cloths())
        for (const Matrix matrix : {Matrix::consistent, Matrix::printed})
            for (const float alpha : {1.0f, 1.05f, 1.5f})
                for (const int sub_steps : {1, 3, 20})
                    for (const double speed : {0.3, 3.0, 30.0}) {
                        CAPTURE(cloth.name, static_cast<int>(matrix), alpha, sub_steps, speed);
                        std::vector<double> given(cloth.positions.size());
                        for (std::size_t n = 0; n < given.size(); ++n)
                            given[n] = speed * std::sin(1.7 * static_cast<double>(n * n));
                        const Parameters parameters{.regularization = alpha, .sub_steps = sub_steps};
                        const auto [velocities, stats] = run_filter<double>(cloth, given, parameters, matrix);
                        const Change before = change_after(cloth, given, parameters.time_step);
                        const Change after = change_after(cloth, velocities, parameters.time_step);
                        if (stats.status == Status::diverged) {
                            CHECK(velocities == given);
                            continue;
                        }
                        CHECK(stats.initial_max_area_change == Approx(before.max).epsilon(1e-5).margin(1e-9));
                        CHECK(stats.initial_rms_area_change == Approx(before.rms).epsilon(1e-5).margin(1e-9));
                        CHECK(stats.max_area_change == Approx(after.max).epsilon(1e-5).margin(1e-9));
                        CHECK(stats.rms_area_change == Approx(after.rms).epsilon(1e-5).margin(1e-9));
                        CHECK(after.capped_rms <= before.capped_rms * (1.0 + 1e-9));
                        if (stats.status == Status::worsened) {
                            ++(velocities == given ? dropped : rose);
                            const bool named = velocities != given && after.max > before.max;
                            CHECK(stats.offender == (named ? Offender::triangle : Offender::none));
                            if (named) CHECK(stats.offender_index == after.worst);
                        } else {
                            CHECK(after.max <= before.max * (1.0 + 1e-9));
                            ++fell;
                        }
                    }
    // Each of the three happens.
    CHECK(fell > 0);
    CHECK(rose > 0);
    CHECK(dropped > 0);
}
