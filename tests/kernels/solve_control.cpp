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
        arrays.write_partials(0, APSLK_PARTIAL_MAX_CHANGE, {0.1, 0.0, 0.3, 0.2, 0.0});
        arrays.write_partials(0, APSLK_PARTIAL_SQUARED_CHANGE, {0.25, 0.25, 0.125, 0.125, 0.25});
        arrays.write_partials(0, APSLK_PARTIAL_MEASURED, {20.0, 20.0, 20.0, 20.0, 20.0});
        arrays.write_partials(0, APSLK_PARTIAL_NOT_FINITE, {0.0, 0.0, 0.0, 0.0, 0.0});
        arrays.write_partials(0, APSLK_PARTIAL_BAD_VERTICES, {0.0, 0.0, 0.0, 0.0, 0.0});
        arrays.write_partials(0, APSLK_PARTIAL_RESIDUAL_EVEN, {1.0, 2.0, 3.0, 4.0, 5.0});
    }
    apslk_solve_state state() const { return arrays.states.read()[0]; }
    apslk_stats stats() const { return arrays.stats.read()[0]; }
};

}  // namespace

TEST_CASE("begin_solve: begins a sub-step with the sum of the residual's parts", "[begin_solve]") {
    for (const std::uint32_t group : work_group_sizes()) {
        Reported reported({.regularization = 1.2f, .sub_steps = 2});
        reported.arrays.edit_states([](apslk_solve_state& state) { state.solve_iterations = 7; });
        launch::begin_solve(reported.arrays, {.work_group_size = group}, 1);
        CHECK(reported.state().stopped == 0);
        CHECK(reported.state().initial_squared_residual == 15.0f);
        CHECK(reported.state().solve_iterations == 0);
        CHECK(reported.stats().sub_steps == 1);
        CHECK(reported.stats().status == APSLK_STATUS_OK);
    }
}

TEST_CASE("begin_solve: stops at the target, at the count, and once stopped stays so", "[begin_solve]") {
    SECTION("at the target") {
        Reported at({.regularization = 1.2f, .sub_steps = 10, .target_area_change = 0.3f});
        launch::begin_solve(at.arrays, {}, 0);
        CHECK(at.state().stopped == 1);
        CHECK(at.stats().sub_steps == 0);
        CHECK(at.stats().status == APSLK_STATUS_OK);
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
        reported.arrays.edit_states([](apslk_solve_state& state) { state.stopped = 1; });
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
               reported.stats().status == APSLK_STATUS_DIVERGED;
    };
    CHECK(diverges(APSLK_PARTIAL_NOT_FINITE, {0.0, 0.0, 0.0, 1.0, 0.0}));
    CHECK(diverges(APSLK_PARTIAL_RESIDUAL_EVEN, {0.0, 0.0, std::nan(""), 0.0, 0.0}));
    CHECK(diverges(APSLK_PARTIAL_RESIDUAL_EVEN, {infinity, 0.0, 0.0, 0.0, 0.0}));
}

TEST_CASE("end_call: greatest and RMS change of all groups", "[end_call]") {
    for (const std::uint32_t group : work_group_sizes()) {
        Reported reported(paper_setting);
        launch::end_call(reported.arrays, {.work_group_size = group});
        CHECK(reported.stats().max_area_change == 0.3f);
        CHECK(std::abs(static_cast<double>(reported.stats().rms_area_change) - 0.1) <= elementwise_tolerance(3) * 0.1);
        CHECK(reported.stats().status == APSLK_STATUS_OK);
    }
}

TEST_CASE("end_call: what a whole step keeps of the energy that vertices gained", "[end_call][energy]") {
    // Σ m |u|²: free 9, or with 8 J of hinges 25; left 100, of which 95 are gains; of 4 kg at what pins have twice
    // their speed. A triangle misses its limits by 10 %.
    struct Given {
        double free = 9.0, bending = 0.0, bending_left = 0.0, alone = 0.0, along = 0.0, pulling = 0.0, left = 100.0,
               gained = 95.0, worst = 0.1;
        bool flies = false;
        float pins = 0.0f;
        int solves = 5;
    };
    struct Ended {
        apslk_solve_state kept;
        float energy;
    };
    const auto ended = [](std::uint32_t group, const Given& given) {
        Reported reported({.regularization = 1.2f, .sub_steps = 5, .stepping = Stepping::small_steps});
        const auto write = [&](int kind, double sum) {
            reported.arrays.write_partials(0, kind, {0.5 * sum, 0.0, 0.25 * sum, 0.0, 0.25 * sum});
        };
        write(APSLK_PARTIAL_FREE_ENERGY, given.free);
        write(APSLK_PARTIAL_BENDING_ENERGY, given.bending);
        write(APSLK_PARTIAL_BENDING_LEFT, given.bending_left);
        write(APSLK_PARTIAL_LEFT_ENERGY, given.left);
        write(APSLK_PARTIAL_GAINED_ENERGY, given.gained);
        write(APSLK_PARTIAL_ADDED_ALONE, given.alone);
        write(APSLK_PARTIAL_ADDED_ALONG, given.along);
        write(APSLK_PARTIAL_PULLING, given.pulling);
        reported.arrays.write_partials(0, APSLK_PARTIAL_WORST_MISS, {0.0, 0.0, given.worst, 0.0, 0.5 * given.worst});
        reported.arrays.edit_states([&](apslk_solve_state& state) {
            state.pins = given.pins;
            state.mass = 4.0f;
            state.flies = given.flies;
            state.initial_capped_rms = 1.0f;
        });
        std::vector<apslk_stats> stats = reported.arrays.stats.read();
        stats[0].sub_steps = given.solves;
        stats[0].initial_max_area_change = stats[0].initial_rms_area_change = 1.0f;
        reported.arrays.stats.write(stats);
        launch::end_call(reported.arrays, {.work_group_size = group, .integrates = true});
        return Ended{reported.state(), reported.stats().energy_kept};
    };
    for (const std::uint32_t group : work_group_sizes()) {
        CAPTURE(group);
        const auto check = [&](const Given& given, double gain, double speed, double energy) {
            CAPTURE(given.free, given.bending, given.bending_left, given.along, given.left, given.worst, given.pins);
            const Ended end = ended(group, given);
            CHECK(end.kept.gain_kept == Approx(gain).margin(1e-6));
            CHECK(end.kept.speed_kept == Approx(speed));
            CHECK(end.energy == Approx(energy));
        };
        const auto allowed = [&](const Given& given, double energy) {
            check(given, 1.0 - (100.0 - energy) / 95.0, 1.0, energy / 100.0);
        };
        allowed({}, 9.0);
        // What three of four parts gave, by a third more.
        allowed({.bending = 6.0}, 25.0);
        allowed({.bending = 7.0, .bending_left = 1.0}, 25.0);
        allowed({.bending = 1.0, .bending_left = 7.0}, 9.0);
        // Pins: 1 in addition to 3 would be more than twice their own; 2 to 4.
        allowed({.pins = 0.5f}, 9.0);
        allowed({.pins = 1.0f}, 16.0);
        allowed({.pins = 2.0f}, 49.0);
        allowed({.alone = 4.0, .pins = 1.0f}, 36.0);
        // What hangs on vertices of 1 kg is the cloth's 4; on those of 0.1 kg 16 times as much counts.
        allowed({.along = 1.0, .pulling = 1.0}, 25.0);
        allowed({.along = 0.25, .pulling = 0.1}, 25.0);
        allowed({.along = 4.0, .pulling = 8.0}, 25.0);
        check({.pins = 5.0f}, 1.0, 1.0, 1.0);
        check({.left = 8.0}, 1.0, 1.0, 1.0);
        check({.left = 9.01}, 1.0, 1.0, 1.0);  // what is let pass
        check({.left = infinity, .gained = infinity}, 0.0, 1.0, 0.0);
        // Limits that are missed by less let more pass: at 2.5 % a fifth, at 0.25 % nearly four times.
        check({.left = 10.7, .gained = 9.0, .worst = 0.025}, 1.0, 1.0, 1.0);
        check({.left = 10.9, .gained = 9.0, .worst = 0.025}, 1.0 - 1.9 / 9.0, 1.0, 9.0 / 10.9);
        check({.left = 43.0, .worst = 0.0025}, 1.0, 1.0, 1.0);
        check({.worst = 0.0}, 1.0, 1.0, 1.0);
        // Where all gains are not enough, the rest is slowed: 20 of 25 too many.
        check({.free = 5.0, .left = 100.0, .gained = 75.0}, 0.0, std::sqrt(0.2), 0.05);
        check({.free = -1.0, .left = 100.0, .gained = 75.0}, 0.0, 0.0, 0.0);
        check({.flies = true}, 1.0, 0.3, 0.09);
        CHECK(ended(group, {.solves = 0}).energy == 1.0f);  // free motion stands
    }
}

TEST_CASE("end_call: a call that went wrong is diverged, no measured triangle means no change", "[end_call]") {
    Reported wrong(paper_setting);
    wrong.arrays.write_partials(0, APSLK_PARTIAL_NOT_FINITE, {0.0, 0.0, 2.0, 0.0, 0.0});
    launch::end_call(wrong.arrays, {});
    CHECK(wrong.stats().status == APSLK_STATUS_DIVERGED);

    Reported empty(paper_setting);
    for (const int kind : {APSLK_PARTIAL_MAX_CHANGE, APSLK_PARTIAL_SQUARED_CHANGE, APSLK_PARTIAL_MEASURED})
        empty.arrays.write_partials(0, kind, std::vector<double>(groups, 0.0));
    launch::end_call(empty.arrays, {});
    CHECK(empty.stats().max_area_change == 0.0f);
    CHECK(empty.stats().rms_area_change == 0.0f);
}

TEST_CASE("judge_whole_step: what a whole step would do, and a stop at the target", "[judge_whole_step]") {
    const auto begun = [](float target, float small_steps) {
        Reported reported({.sub_steps = static_cast<int>(small_steps) + 1,
                           .target_area_change = target,
                           .stepping = small_steps > 0.0f ? Stepping::small_steps : Stepping::whole_step});
        launch::judge_whole_step(reported.arrays, {});
        return std::pair(reported.stats(), reported.state());
    };
    const auto [stats, state] = begun(0.25f, 3.0f);
    CHECK(stats.initial_max_area_change == 0.3f);
    CHECK(stats.initial_rms_area_change == Approx(0.1f).epsilon(1e-6));
    CHECK(state.stopped == 0);
    CHECK(begun(0.3f, 3.0f).second.stopped == 1);
    // Where the step is whole, begin_solve decides.
    CHECK(begun(0.3f, 0.0f).second.stopped == 0);
    CHECK(begun(0.3f, 0.0f).first.initial_max_area_change == 0.0f);
}

TEST_CASE("judge_whole_step: with a stretch ceiling sub-steps follow the excess, and what was asked for",
          "[judge_whole_step][stretch_ceiling]") {
    const auto taken = [](double excess, float asked) {
        Reported reported({.sub_steps = 4, .most_sub_steps = 9, .stepping = Stepping::small_steps});
        reported.arrays.write_partials(0, APSLK_PARTIAL_MAX_EXCESS, {0.0, excess, 0.0, 0.0, 0.0});
        for (const int kind : {APSLK_PARTIAL_MAX_STRETCH, APSLK_PARTIAL_SQUARED_EXCESS})
            reported.arrays.write_partials(0, kind, std::vector<double>(groups, 0.0));
        reported.arrays.edit_states([&](apslk_solve_state& state) { state.asked_sub_steps = asked; });
        launch::judge_whole_step(reported.arrays, {.chebyshev = true, .limits_stretch = true});
        const apslk_parameters parameters = reported.arrays.parameters.read()[0];
        CHECK(parameters.small_steps == parameters.sub_steps - 1);
        return parameters.sub_steps;
    };
    CHECK(taken(0.0, 0.0f) == 4);
    CHECK(taken(1.5, 0.0f) == 7);  // 1.5 / 0.23 = 6.5
    CHECK(taken(1.5, 7.5f) == 8);
    CHECK(taken(1e30, 0.0f) == 9);
}

TEST_CASE("end_call: the tension of a call asks the next for sub-steps",
          "[end_call][stretch_ceiling][exact_division]") {
    const auto asked = [](int sub_steps, double mass_ratio, bool finite) {
        Reported reported({.sub_steps = 30});
        for (const int kind : {APSLK_PARTIAL_MAX_STRETCH, APSLK_PARTIAL_MAX_EXCESS, APSLK_PARTIAL_SQUARED_EXCESS,
                               APSLK_PARTIAL_STRETCH_ROWS, APSLK_PARTIAL_RAISED, APSLK_PARTIAL_EXTENT})
            reported.arrays.write_partials(0, kind, std::vector<double>(groups, 0.0));
        reported.arrays.write_partials(0, APSLK_PARTIAL_MASS_RATIO, {1.0, mass_ratio, 1.0, 1.0, 1.0});
        if (!finite) reported.arrays.write_partials(0, APSLK_PARTIAL_NOT_FINITE, {1.0, 0.0, 0.0, 0.0, 0.0});
        std::vector<apslk_stats> stats = reported.arrays.stats.read();
        stats[0].sub_steps = sub_steps;
        reported.arrays.stats.write(stats);
        reported.arrays.edit_states([&](apslk_solve_state& state) { state.asked_sub_steps = 50.0f; });
        launch::end_call(reported.arrays, {.chebyshev = true, .limits_stretch = true});
        return reported.state().asked_sub_steps;
    };
    CHECK(asked(30, 29.0, true) == 60.0f);
    CHECK(asked(30, 1.0, true) == 40.0f);
    CHECK(asked(0, 29.0, true) == 40.0f);
    CHECK(asked(30, 29.0, false) == 50.0f);
}

TEST_CASE("begin_solve: in small steps only its end is held against the target", "[begin_solve]") {
    for (const int sub_step : {0, 2, 3}) {
        CAPTURE(sub_step);
        Reported reported({.sub_steps = 4, .target_area_change = 0.3f, .stepping = Stepping::small_steps});
        launch::begin_solve(reported.arrays, {}, sub_step);
        CHECK(reported.state().stopped == (sub_step == 3 ? 1 : 0));
        CHECK(reported.stats().initial_max_area_change == 0.0f);  // judge_whole_step's
    }
}

TEST_CASE("end_call: never worse than at the start", "[end_call]") {
    struct Outcome {
        float initial_max, initial_rms;
        int status, discarded;
        float max, rms;
    };
    // What the groups report is 0.3 and 0.1.
    const std::vector<Outcome> outcomes{
        {0.4f, 0.2f, APSLK_STATUS_OK, 0, 0.3f, 0.1f},          // both fell
        {0.2f, 0.2f, APSLK_STATUS_WORSENED, 0, 0.3f, 0.1f},    // the greatest rose, the capped RMS fell
        {0.4f, 0.05f, APSLK_STATUS_WORSENED, 1, 0.4f, 0.05f},  // the capped RMS rose
        {0.2f, 0.05f, APSLK_STATUS_WORSENED, 1, 0.2f, 0.05f},  // both rose
        {9e-6f, 3e-6f, APSLK_STATUS_OK, 1, 9e-6f, 3e-6f},      // was at rest
    };
    for (const Outcome& expected : outcomes) {
        CAPTURE(expected.initial_max, expected.initial_rms);
        Reported reported(paper_setting);
        apslk_stats stats{};
        stats.sub_steps = 10;
        stats.initial_max_area_change = expected.initial_max;
        stats.initial_rms_area_change = expected.initial_rms;
        reported.arrays.stats.write({stats});
        // The RMS has no say but in the status; the capped one is as great here.
        reported.arrays.write_partial_sum(0, APSLK_PARTIAL_CAPPED_CHANGE, 0.01);
        reported.arrays.write_partial_sum(0, APSLK_PARTIAL_MEASURED, 1.0);
        reported.arrays.write_partial_sum(0, APSLK_PARTIAL_SQUARED_CHANGE, 0.01);
        reported.arrays.write_partial_sum(0, APSLK_PARTIAL_EXTENT, 0.0);
        reported.arrays.edit_states([&](apslk_solve_state& state) { state.initial_capped_rms = expected.initial_rms; });
        launch::end_call(reported.arrays, {});
        const apslk_stats got = reported.stats();
        CHECK(got.status == expected.status);
        CHECK(reported.state().discarded == expected.discarded);
        CHECK(got.max_area_change == expected.max);
        CHECK(got.rms_area_change == Approx(expected.rms).epsilon(1e-6));
    }
}

TEST_CASE("end_call: with a stretch ceiling an excess may grow by half where areas are better", "[end_call]") {
    struct Outcome {
        float initial_rms, initial_rms_excess;
        int discarded;
    };
    // What the groups report is an RMS of 0.1 of areas and of 0.3 of the excess.
    const std::vector<Outcome> outcomes{
        {0.2f, 0.25f, 0}, {0.2f, 0.1f, 0}, {0.12f, 0.1f, 1}, {0.09f, 0.31f, 0}, {0.09f, 0.25f, 1}};
    for (const Outcome& expected : outcomes) {
        CAPTURE(expected.initial_rms, expected.initial_rms_excess);
        Reported reported(paper_setting);
        const float both = std::hypot(expected.initial_rms, expected.initial_rms_excess);
        apslk_stats stats{};
        stats.sub_steps = 10;
        stats.initial_max_area_change = stats.initial_rms_area_change = expected.initial_rms;
        stats.initial_max_stretch_excess = stats.initial_rms_stretch_excess = expected.initial_rms_excess;
        reported.arrays.stats.write({stats});
        for (const int kind : {APSLK_PARTIAL_MAX_STRETCH, APSLK_PARTIAL_MAX_EXCESS, APSLK_PARTIAL_STRETCH_ROWS,
                               APSLK_PARTIAL_EXTENT, APSLK_PARTIAL_RAISED})
            reported.arrays.write_partial_sum(0, kind, 0.0);
        reported.arrays.write_partial_sum(0, APSLK_PARTIAL_MEASURED, 1.0);
        reported.arrays.write_partial_sum(0, APSLK_PARTIAL_SQUARED_CHANGE, 0.01);
        reported.arrays.write_partial_sum(0, APSLK_PARTIAL_SQUARED_EXCESS, 0.09);
        reported.arrays.write_partial_sum(0, APSLK_PARTIAL_CAPPED_CHANGE, 0.1);
        reported.arrays.edit_states([&](apslk_solve_state& state) { state.initial_capped_rms = both; });
        launch::end_call(reported.arrays, {.chebyshev = true, .limits_stretch = true});
        CHECK(reported.state().discarded == expected.discarded);
    }
}

TEST_CASE("end_call: names the first vertex or triangle that is not finite", "[end_call][offender]") {
    for (const std::uint32_t group : work_group_sizes()) {
        CAPTURE(group);
        const std::vector<Cloth> cloths{make_cloth(strip(300), 1), make_cloth(strip(300), 2)};
        const auto broken = [&](int bad_vertices, const auto& spoil) {
            Arrays arrays(cloths, Matrix::printed, paper_setting, groups);
            for (std::size_t c = 0; c < 2; ++c)
                for (const int kind : {APSLK_PARTIAL_MAX_CHANGE, APSLK_PARTIAL_SQUARED_CHANGE, APSLK_PARTIAL_MEASURED,
                                       APSLK_PARTIAL_NOT_FINITE, APSLK_PARTIAL_BAD_VERTICES})
                    arrays.write_partial_sum(c, kind, 0.0);
            arrays.write_partial_sum(1, bad_vertices > 0 ? APSLK_PARTIAL_BAD_VERTICES : APSLK_PARTIAL_NOT_FINITE, 2.0);
            spoil(arrays);
            launch::end_call(arrays, {.work_group_size = group});
            CHECK(arrays.stats.read()[0].status == APSLK_STATUS_OK);
            CHECK(arrays.stats.read()[0].offender == APSLK_OFFENDER_NONE);
            CHECK(arrays.states.read()[1].discarded == 1);
            return arrays.stats.read()[1];
        };
        const std::size_t first_vertex = cloths[0].topology->vertex_count();
        const apslk_stats vertex = broken(2, [&](Arrays& arrays) {
            std::vector<cl_float4> moved = arrays.moved.read();
            moved[arrays.vertex_places[first_vertex + 211]].s[1] = static_cast<float>(infinity);
            moved[arrays.vertex_places[first_vertex + 44]].s[3] = -1.0f;
            arrays.moved.write(moved);
        });
        CHECK(vertex.status == APSLK_STATUS_DIVERGED);
        CHECK(vertex.offender == APSLK_OFFENDER_VERTEX);
        CHECK(vertex.offender_index == 44);
        const apslk_stats triangle = broken(0, [&](Arrays& arrays) {
            std::vector<float> rest_areas = arrays.ordered_rest.read();
            rest_areas[arrays.triangle_places[1][299]] = static_cast<float>(std::nan(""));
            rest_areas[arrays.triangle_places[1][131]] = -1.0f;
            arrays.ordered_rest.write(rest_areas);
        });
        CHECK(triangle.offender == APSLK_OFFENDER_TRIANGLE);
        CHECK(triangle.offender_index == 131);
    }
}
