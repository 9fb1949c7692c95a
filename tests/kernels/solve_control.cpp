// SPDX-License-Identifier: MIT
#include "kernels/launch.hpp"
#include "support/tolerances.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <tuple>

using namespace apsl;
using namespace apsl::test;

namespace {

constexpr std::uint32_t groups = 5;
constexpr double infinity = std::numeric_limits<double>::infinity();

// A single cloth whose groups report: greatest change 0.3, RMS 0.1, capped RMS 0.05, ‖b‖² = 15, all finite; Σ √m = 6
// over 20 vertices, of which three weigh up to 7 times what was given; nothing further than 2 m from the origin.
struct Reported {
    std::vector<Cloth> cloths{make_cloth(strip(9), 1)};
    Arrays arrays;

    explicit Reported(const Parameters& parameters) : arrays(cloths, Matrix::printed, parameters, groups) {
        arrays.write_partials(0, APSL_PARTIAL_MAX_CHANGE, {0.1, 0.0, 0.3, 0.2, 0.0});
        arrays.write_partials(0, APSL_PARTIAL_SQUARED_CHANGE, {0.25, 0.25, 0.125, 0.125, 0.25});
        arrays.write_partials(0, APSL_PARTIAL_CAPPED_CHANGE, {0.04, 0.05, 0.07, 0.05, 0.04});
        arrays.write_partials(0, APSL_PARTIAL_ROOT_MASSES, {1.0, 2.0, 0.0, 2.0, 1.0});
        arrays.write_partials(0, APSL_PARTIAL_MOVABLE, {5.0, 5.0, 0.0, 5.0, 5.0});
        arrays.write_partials(0, APSL_PARTIAL_EXTENT, {1.0, 2.0, 0.0, 2.0, 1.0});
        arrays.write_partials(0, APSL_PARTIAL_RAISED, {0.0, 2.0, 0.0, 1.0, 0.0});
        arrays.write_partials(0, APSL_PARTIAL_MASS_RATIO, {1.0, 3.0, 1.0, 7.0, 1.0});
        arrays.write_partials(0, APSL_PARTIAL_MEASURED, {20.0, 20.0, 20.0, 20.0, 20.0});
        arrays.write_partials(0, APSL_PARTIAL_NOT_FINITE, {0.0, 0.0, 0.0, 0.0, 0.0});
        arrays.write_partials(0, APSL_PARTIAL_BAD_VERTICES, {0.0, 0.0, 0.0, 0.0, 0.0});
        arrays.write_partials(0, APSL_PARTIAL_RESIDUAL_EVEN, {1.0, 2.0, 3.0, 4.0, 5.0});
    }
    apsl_solve_state state() const { return arrays.states.read()[0]; }
    apsl_stats stats() const { return arrays.stats.read()[0]; }
};

}  // namespace

TEST_CASE("begin_solve: begins a sub-step with the sum of the residual's parts", "[begin_solve]") {
    for (const std::uint32_t group : work_group_sizes()) {
        Reported reported({.regularization = 1.2f, .sub_steps = 2});
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
        Reported at({.regularization = 1.2f, .sub_steps = 10, .target_area_change = 0.3f});
        launch::begin_solve(at.arrays, {}, 0);
        CHECK(at.state().stopped == 1);
        CHECK(at.stats().sub_steps == 0);
        CHECK(at.stats().status == APSL_STATUS_OK);
        Reported above({.regularization = 1.2f, .sub_steps = 10, .target_area_change = 0.29f});
        launch::begin_solve(above.arrays, {}, 0);
        CHECK(above.state().stopped == 0);
    }
    SECTION("at the count of this cloth") {
        Reported reported({.regularization = 1.2f, .sub_steps = 2});
        launch::begin_solve(reported.arrays, {}, 2);
        CHECK(reported.state().stopped == 1);
        CHECK(reported.stats().sub_steps == 0);
    }
    SECTION("once stopped") {
        Reported reported(paper_setting);
        reported.arrays.edit_states([](apsl_solve_state& state) { state.stopped = 1; });
        const auto before = reported.arrays.states.read();
        launch::begin_solve(reported.arrays, {}, 0);
        CHECK(same_bytes(before, reported.arrays.states.read()));
        CHECK(reported.stats().sub_steps == 0);
    }
}

TEST_CASE("begin_solve: what is not finite is diverged", "[begin_solve]") {
    const auto diverges = [](int kind, const std::vector<double>& numbers) {
        Reported reported(paper_setting);
        reported.arrays.write_partials(0, kind, numbers);
        launch::begin_solve(reported.arrays, {}, 0);
        return reported.state().stopped == 1 && reported.stats().sub_steps == 0 &&
               reported.stats().status == APSL_STATUS_DIVERGED;
    };
    CHECK(diverges(APSL_PARTIAL_NOT_FINITE, {0.0, 0.0, 0.0, 1.0, 0.0}));
    CHECK(diverges(APSL_PARTIAL_RESIDUAL_EVEN, {0.0, 0.0, std::nan(""), 0.0, 0.0}));
    CHECK(diverges(APSL_PARTIAL_RESIDUAL_EVEN, {infinity, 0.0, 0.0, 0.0, 0.0}));
    // No area change is told of where none can be.
    Reported reported(paper_setting);
    reported.arrays.write_partials(0, APSL_PARTIAL_NOT_FINITE, {0.0, 0.0, 0.0, 1.0, 0.0});
    reported.arrays.write_partials(0, APSL_PARTIAL_MAX_CHANGE, {0.1, infinity, 0.0, 0.0, 0.0});
    launch::begin_solve(reported.arrays, {}, 0);
    CHECK(reported.stats().initial_max_area_change == 0.0f);
    CHECK(reported.stats().initial_rms_area_change == 0.0f);
    CHECK(reported.state().initial_capped_rms == 0.0f);
}

TEST_CASE("end_call: greatest and RMS change of all groups", "[end_call]") {
    for (const std::uint32_t group : work_group_sizes()) {
        Reported reported(paper_setting);
        launch::end_call(reported.arrays, {.work_group_size = group});
        CHECK(reported.stats().max_area_change == 0.3f);
        CHECK(std::abs(static_cast<double>(reported.stats().rms_area_change) - 0.1) <= elementwise_tolerance(3) * 0.1);
        CHECK(reported.stats().status == APSL_STATUS_OK);
    }
}

TEST_CASE("end_call: a call that went wrong is diverged, no measured triangle means no change", "[end_call]") {
    Reported wrong(paper_setting);
    wrong.arrays.write_partials(0, APSL_PARTIAL_NOT_FINITE, {0.0, 0.0, 2.0, 0.0, 0.0});
    launch::end_call(wrong.arrays, {});
    CHECK(wrong.stats().status == APSL_STATUS_DIVERGED);

    Reported empty(paper_setting);
    for (const int kind : {APSL_PARTIAL_MAX_CHANGE, APSL_PARTIAL_SQUARED_CHANGE, APSL_PARTIAL_MEASURED})
        empty.arrays.write_partials(0, kind, std::vector<double>(groups, 0.0));
    launch::end_call(empty.arrays, {});
    CHECK(empty.stats().max_area_change == 0.0f);
    CHECK(empty.stats().rms_area_change == 0.0f);
}

TEST_CASE("begin_call: what a whole step would do, and a stop at the target", "[begin_call]") {
    const auto begun = [](float target, float walked) {
        Reported reported({.sub_steps = static_cast<int>(walked) + 1,
                           .target_area_change = target,
                           .stepping = walked > 0.0f ? Stepping::small_steps : Stepping::whole_step});
        launch::begin_call(reported.arrays, {});
        return std::pair(reported.stats(), reported.state());
    };
    const auto [stats, state] = begun(0.25f, 3.0f);
    CHECK(state.initial_capped_rms == Approx(0.05f).epsilon(1e-6));
    CHECK(state.greatest_mass == Approx(0.9f).epsilon(1e-6));  // 10 (6/20)²
    CHECK(stats.initial_max_area_change == 0.3f);
    CHECK(stats.initial_rms_area_change == Approx(0.1f).epsilon(1e-6));
    CHECK(state.stopped == 0);
    CHECK(begun(0.3f, 3.0f).second.stopped == 1);
    // Where the step is whole, begin_solve decides.
    CHECK(begun(0.3f, 0.0f).second.stopped == 0);
    CHECK(begun(0.3f, 0.0f).first.initial_max_area_change == 0.0f);
}

TEST_CASE("begin_solve: on a walk only its end is held against the target", "[begin_solve]") {
    for (const int sub_step : {0, 2, 3}) {
        CAPTURE(sub_step);
        Reported reported({.sub_steps = 4, .target_area_change = 0.3f, .stepping = Stepping::small_steps});
        launch::begin_solve(reported.arrays, {}, sub_step);
        CHECK(reported.state().stopped == (sub_step == 3 ? 1 : 0));
        CHECK(reported.stats().initial_max_area_change == 0.0f);  // begin_call's
    }
}

TEST_CASE("end_call: the capped RMS decides which state stands", "[end_call]") {
    struct Outcome {
        float initial_max, initial_rms, initial_capped_rms;
        int status, discarded;
        float max, rms;
    };
    // What the groups report is 0.3, 0.1 and 0.05.
    const std::vector<Outcome> outcomes{
        {0.4f, 0.2f, 0.1f, APSL_STATUS_OK, 0, 0.3f, 0.1f},           // all fell
        {0.2f, 0.2f, 0.1f, APSL_STATUS_WORSENED, 0, 0.3f, 0.1f},     // the greatest rose, the capped RMS fell
        {0.2f, 0.05f, 0.06f, APSL_STATUS_WORSENED, 0, 0.3f, 0.1f},   // the RMS rose too
        {0.4f, 0.05f, 0.06f, APSL_STATUS_WORSENED, 0, 0.3f, 0.1f},   // the RMS alone rose
        {0.4f, 0.2f, 0.04f, APSL_STATUS_WORSENED, 1, 0.4f, 0.2f},    // the capped RMS alone rose
        {0.2f, 0.05f, 0.04f, APSL_STATUS_WORSENED, 1, 0.2f, 0.05f},  // all rose
        {9e-6f, 3e-6f, 3e-6f, APSL_STATUS_OK, 1, 9e-6f, 3e-6f},      // was at rest
    };
    for (const Outcome& expected : outcomes) {
        CAPTURE(expected.initial_max, expected.initial_rms, expected.initial_capped_rms);
        Reported reported(paper_setting);
        apsl_stats stats{};
        stats.sub_steps = 10;
        stats.initial_max_area_change = expected.initial_max;
        stats.initial_rms_area_change = expected.initial_rms;
        reported.arrays.stats.write({stats});
        reported.arrays.edit_states(
            [&](apsl_solve_state& state) { state.initial_capped_rms = expected.initial_capped_rms; });
        launch::end_call(reported.arrays, {});
        const apsl_stats got = reported.stats();
        CHECK(got.status == expected.status);
        CHECK(reported.state().discarded == expected.discarded);
        CHECK(got.max_area_change == expected.max);
        CHECK(got.rms_area_change == Approx(expected.rms).epsilon(1e-6));
        CHECK(got.raised_vertices == 3);
        CHECK(got.greatest_mass_ratio == 7.0f);
    }
}

TEST_CASE("end_call: what the rounding of positions makes counts as rest", "[end_call]") {
    // 2.4e-7 · 2000 m over √(100 m² / 9 triangles): 1.44e-4.
    for (const auto& [initial_max, extent, status] :
         {std::tuple{1.4e-4f, 2000.0, APSL_STATUS_OK}, std::tuple{1.5e-4f, 2000.0, APSL_STATUS_WORSENED},
          std::tuple{1.4e-4f, 200.0, APSL_STATUS_WORSENED}, std::tuple{1.4e-4f, infinity, APSL_STATUS_WORSENED}}) {
        CAPTURE(initial_max, extent);
        Reported reported(paper_setting);
        apsl_stats stats{};
        stats.sub_steps = 10;
        stats.initial_max_area_change = initial_max;
        stats.initial_rms_area_change = 1e-4f;
        reported.arrays.stats.write({stats});
        reported.arrays.edit_states([](apsl_solve_state& state) { state.initial_capped_rms = 1e-4f; });
        reported.arrays.write_partials(0, APSL_PARTIAL_EXTENT, {0.0, extent, 0.0, 1.0, 0.0});
        launch::end_call(reported.arrays, {});
        CHECK(reported.stats().status == status);
        CHECK(reported.state().discarded == 1);
        CHECK(reported.stats().max_area_change == initial_max);
    }
}

TEST_CASE("end_call: a diverged call tells of the state as given, whatever the groups report", "[end_call]") {
    for (const int status : {APSL_STATUS_OK, APSL_STATUS_DIVERGED}) {
        Reported reported(paper_setting);
        apsl_stats stats{};
        stats.sub_steps = 10;
        stats.status = status;
        stats.initial_max_area_change = 0.2f;
        stats.initial_rms_area_change = 0.15f;
        reported.arrays.stats.write({stats});
        reported.arrays.edit_states([](apsl_solve_state& state) { state.initial_capped_rms = 0.12f; });
        if (status == APSL_STATUS_OK) reported.arrays.write_partial_sum(0, APSL_PARTIAL_BAD_VERTICES, 1.0);
        launch::end_call(reported.arrays, {});
        CHECK(reported.stats().status == APSL_STATUS_DIVERGED);
        CHECK(reported.state().discarded == 1);
        CHECK(reported.stats().max_area_change == 0.2f);
        CHECK(reported.stats().rms_area_change == 0.15f);
    }
}

TEST_CASE("end_call: names the triangle with the greatest area change, if that rose and stands",
          "[end_call][offender]") {
    for (const std::uint32_t group : work_group_sizes()) {
        CAPTURE(group);
        std::vector<Cloth> cloths{make_cloth(strip(300), 1), make_cloth(strip(300), 2)};
        cloths[1].rest_areas[131] /= 4.0;
        const auto ended = [&](float initial_max, float initial_capped_rms) {
            Arrays arrays(cloths, Matrix::consistent, paper_setting, groups);
            arrays.edit_states([&](apsl_solve_state& state) { state.initial_capped_rms = initial_capped_rms; });
            apsl_stats stats{};
            stats.sub_steps = 10;
            stats.initial_max_area_change = initial_max;
            stats.initial_rms_area_change = 1.0f;
            arrays.stats.write({stats, stats});
            launch::measure_area_change(arrays, {.work_group_size = group});
            for (std::size_t c = 0; c < 2; ++c)
                for (const int kind : {APSL_PARTIAL_BAD_VERTICES, APSL_PARTIAL_EXTENT})
                    arrays.write_partial_sum(c, kind, 0.0);
            launch::end_call(arrays, {.work_group_size = group});
            CHECK(arrays.stats.read()[0].offender == APSL_OFFENDER_NONE);  // no triangle is off by more than a third
            return arrays.stats.read()[1];
        };
        const apsl_stats named = ended(1.5f, 1.0f);
        CHECK(named.status == APSL_STATUS_WORSENED);
        CHECK(named.offender == APSL_OFFENDER_TRIANGLE);
        CHECK(named.offender_index == 131);
        const apsl_stats dropped = ended(1.5f, 0.01f);
        CHECK(dropped.status == APSL_STATUS_WORSENED);
        CHECK(dropped.offender == APSL_OFFENDER_NONE);
        CHECK(dropped.max_area_change == 1.5f);
        const apsl_stats fell = ended(10.0f, 1.0f);
        CHECK(fell.status == APSL_STATUS_OK);
        CHECK(fell.offender == APSL_OFFENDER_NONE);
    }
}

TEST_CASE("end_call: names the first vertex or triangle that is not finite", "[end_call][offender]") {
    for (const std::uint32_t group : work_group_sizes()) {
        CAPTURE(group);
        const std::vector<Cloth> cloths{make_cloth(strip(300), 1), make_cloth(strip(300), 2)};
        const auto broken = [&](int bad_vertices, const auto& spoil) {
            Arrays arrays(cloths, Matrix::printed, paper_setting, groups);
            for (std::size_t c = 0; c < 2; ++c)
                for (const int kind : {APSL_PARTIAL_MAX_CHANGE, APSL_PARTIAL_SQUARED_CHANGE, APSL_PARTIAL_MEASURED,
                                       APSL_PARTIAL_NOT_FINITE, APSL_PARTIAL_BAD_VERTICES})
                    arrays.write_partial_sum(c, kind, 0.0);
            arrays.write_partial_sum(1, bad_vertices > 0 ? APSL_PARTIAL_BAD_VERTICES : APSL_PARTIAL_NOT_FINITE, 2.0);
            spoil(arrays);
            launch::end_call(arrays, {.work_group_size = group});
            CHECK(arrays.stats.read()[0].status == APSL_STATUS_OK);
            CHECK(arrays.stats.read()[0].offender == APSL_OFFENDER_NONE);
            CHECK(arrays.states.read()[1].discarded == 1);
            return arrays.stats.read()[1];
        };
        const std::size_t first_vertex = cloths[0].topology->vertex_count();
        const apsl_stats vertex = broken(2, [&](Arrays& arrays) {
            std::vector<cl_float4> predicted = arrays.predicted.read();
            predicted[arrays.vertex_places[first_vertex + 211]].s[1] = static_cast<float>(infinity);
            predicted[arrays.vertex_places[first_vertex + 44]].s[3] = -1.0f;
            arrays.predicted.write(predicted);
        });
        CHECK(vertex.status == APSL_STATUS_DIVERGED);
        CHECK(vertex.offender == APSL_OFFENDER_VERTEX);
        CHECK(vertex.offender_index == 44);
        const apsl_stats triangle = broken(0, [&](Arrays& arrays) {
            std::vector<float> rest_areas = arrays.ordered_rest_areas.read();
            rest_areas[arrays.triangle_places[1][299]] = static_cast<float>(std::nan(""));
            rest_areas[arrays.triangle_places[1][131]] = -1.0f;
            arrays.ordered_rest_areas.write(rest_areas);
        });
        CHECK(triangle.offender == APSL_OFFENDER_TRIANGLE);
        CHECK(triangle.offender_index == 131);
    }
}
