// SPDX-License-Identifier: MIT
#include "kernels/launch.hpp"
#include "support/tolerances.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;

namespace {

constexpr std::uint32_t groups = 5;
constexpr double infinity = std::numeric_limits<double>::infinity();

// A single cloth whose groups report: greatest change 0.3, RMS 0.1, ‖b‖² = 15, all finite.
struct Reported {
    std::vector<Cloth> cloths{make_cloth(strip(9), 1)};
    Arrays arrays;

    explicit Reported(const Parameters& parameters) : arrays(cloths, Matrix::printed, parameters, groups) {
        arrays.write_partials(0, APSL_PARTIAL_MAX_CHANGE, {0.1, 0.0, 0.3, 0.2, 0.0});
        arrays.write_partials(0, APSL_PARTIAL_SQUARED_CHANGE, {0.25, 0.25, 0.125, 0.125, 0.25});
        arrays.write_partials(0, APSL_PARTIAL_MEASURED, {20.0, 20.0, 20.0, 20.0, 20.0});
        arrays.write_partials(0, APSL_PARTIAL_NOT_FINITE, {0.0, 0.0, 0.0, 0.0, 0.0});
        arrays.write_partials(0, APSL_PARTIAL_RESIDUAL_EVEN, {1.0, 2.0, 3.0, 4.0, 5.0});
    }
    apsl_solve_state state() const { return arrays.states.read()[0]; }
    apsl_stats stats() const { return arrays.stats.read()[0]; }
};

}  // namespace

TEST_CASE("begin_solve: begins a sub-step with the sum of the residual's parts", "[begin_solve]") {
    for (const std::uint32_t group : work_group_sizes()) {
        Reported reported({.sub_steps = 2});
        reported.arrays.edit_states([](apsl_solve_state& state) { state.solve_iterations = 7; });
        launch::begin_solve(reported.arrays, {.work_group_size = group}, 1);
        CHECK(reported.state().stopped == 0);
        CHECK(reported.state().initial_residual == 15.0f);
        CHECK(reported.state().solve_iterations == 0);
        CHECK(reported.stats().sub_steps == 1);
        CHECK(reported.stats().status == APSL_STATUS_OK);
    }
}

TEST_CASE("begin_solve: stops at the target, at the count, and once stopped stays so", "[begin_solve]") {
    SECTION("at the target") {
        Reported at({.target_area_change = 0.3f});
        launch::begin_solve(at.arrays, {}, 0);
        CHECK(at.state().stopped == 1);
        CHECK(at.stats().sub_steps == 0);
        CHECK(at.stats().status == APSL_STATUS_OK);
        Reported above({.target_area_change = 0.29f});
        launch::begin_solve(above.arrays, {}, 0);
        CHECK(above.state().stopped == 0);
    }
    SECTION("at the count of this cloth") {
        Reported reported({.sub_steps = 2});
        launch::begin_solve(reported.arrays, {}, 2);
        CHECK(reported.state().stopped == 1);
        CHECK(reported.stats().sub_steps == 0);
    }
    SECTION("once stopped") {
        Reported reported({});
        reported.arrays.edit_states([](apsl_solve_state& state) { state.stopped = 1; });
        const auto before = reported.arrays.states.read();
        launch::begin_solve(reported.arrays, {}, 0);
        CHECK(same_bytes(before, reported.arrays.states.read()));
        CHECK(reported.stats().sub_steps == 0);
    }
}

TEST_CASE("begin_solve: what is not finite is diverged", "[begin_solve]") {
    const auto diverges = [](int kind, const std::vector<double>& numbers) {
        Reported reported({});
        reported.arrays.write_partials(0, kind, numbers);
        launch::begin_solve(reported.arrays, {}, 0);
        return reported.state().stopped == 1 && reported.stats().sub_steps == 0 &&
               reported.stats().status == APSL_STATUS_DIVERGED;
    };
    CHECK(diverges(APSL_PARTIAL_NOT_FINITE, {0.0, 0.0, 0.0, 1.0, 0.0}));
    CHECK(diverges(APSL_PARTIAL_RESIDUAL_EVEN, {0.0, 0.0, std::nan(""), 0.0, 0.0}));
    CHECK(diverges(APSL_PARTIAL_RESIDUAL_EVEN, {infinity, 0.0, 0.0, 0.0, 0.0}));
}

TEST_CASE("end_call: greatest and RMS change of all groups", "[end_call]") {
    for (const std::uint32_t group : work_group_sizes()) {
        Reported reported({});
        launch::end_call(reported.arrays, {.work_group_size = group});
        CHECK(reported.stats().max_area_change == 0.3f);
        CHECK(std::abs(static_cast<double>(reported.stats().rms_area_change) - 0.1) <= elementwise_tolerance(3) * 0.1);
        CHECK(reported.stats().status == APSL_STATUS_OK);
    }
}

TEST_CASE("end_call: a call that went wrong is diverged; no measured triangle means no change", "[end_call]") {
    Reported wrong({});
    wrong.arrays.write_partials(0, APSL_PARTIAL_NOT_FINITE, {0.0, 0.0, 2.0, 0.0, 0.0});
    launch::end_call(wrong.arrays, {});
    CHECK(wrong.stats().status == APSL_STATUS_DIVERGED);

    Reported empty({});
    for (const int kind : {APSL_PARTIAL_MAX_CHANGE, APSL_PARTIAL_SQUARED_CHANGE, APSL_PARTIAL_MEASURED})
        empty.arrays.write_partials(0, kind, std::vector<double>(groups, 0.0));
    launch::end_call(empty.arrays, {});
    CHECK(empty.stats().max_area_change == 0.0f);
    CHECK(empty.stats().rms_area_change == 0.0f);
}
