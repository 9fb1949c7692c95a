// SPDX-License-Identifier: MIT
#include "tune/tuning_search.hpp"

#include "run/parse_scene.hpp"
#include "tune/scene_text.hpp"

#include <catch2/catch.hpp>
#include <set>

using namespace apsl;
using namespace apsl::scenes;

namespace {

// A made-up cloth: area change 0.2 / (sub-steps · steps), 1 ms a sub-step and 10 ms of other work a step; frames from
// `hard_from` on have three times the change. Whatever else is set makes no difference to areas; a lower
// regularization, be it the first sub-step's alone, costs more. Areas alone leave a stretch of 3, a ceiling is overshot
// by a tenth of what it lets through, and costs three times as much.
struct MadeUp {
    int hard_from = 1000;
    double free_stretch = 3.0;
    int trials = 0;
    int frames = 0;

    std::optional<Trial> operator()(const LimiterSettings& s, int count,
                                    const std::function<bool(const Trial&)>& enough) {
        ++trials;
        Trial trial{.settings = s};
        while (trial.frames < count && !trial.cut_short) {
            ++frames;
            const double harder = trial.frames >= hard_from ? 3.0 : 1.0;
            const apsl::Parameters& p = s.limiting.parameters;
            trial.max_area_change = std::max(trial.max_area_change, harder * 0.2 / (p.sub_steps * s.steps_per_frame));
            const double least = p.first_regularization > 0.0f ? p.first_regularization : p.regularization;
            trial.limiter_seconds = 1e-3 * p.sub_steps * s.steps_per_frame * (1.0 + 0.1 * (2.0 - least));
            trial.rest_seconds = 1e-2 * s.steps_per_frame;
            trial.max_stretch = free_stretch;
            if (s.limiting.options.limits_stretch) {
                trial.limiter_seconds *= 3.0;
                trial.max_stretch = std::min(free_stretch, 1.0 + 1.1 * (static_cast<double>(p.stretch_ceiling) - 1.0));
            }
            ++trial.frames;
            trial.cut_short = trial.frames < count && enough(trial);
        }
        return trial;
    }
};

LimiterSettings ten_sub_steps() {
    LimiterSettings settings;
    settings.limiting.options.solver = Solver::conjugate_gradient;
    settings.limiting.parameters.sub_steps = 10;
    settings.limiting.parameters.regularization = 1.2f;
    return settings;
}

LimiterSettings under_a_ceiling(float ceiling) {
    LimiterSettings settings = ten_sub_steps();
    settings.limiting.options.solver = Solver::chebyshev;
    settings.limiting.options.limits_stretch = true;
    settings.limiting.parameters.stretch_ceiling = ceiling;
    return settings;
}

Trial found(const TuningGoal& goal, MadeUp& cloth, int frames, const LimiterSettings& given = ten_sub_steps(),
            const TuningFreedom& freedom = {}) {
    const TrialRun run = [&](const auto& settings, int count, const auto& enough) {
        validate(settings.limiting.options, settings.limiting.parameters);
        return cloth(settings, count, enough);
    };
    return search_settings(goal, given, freedom, frames, run).value();
}

}  // namespace

TEST_CASE("the search finds the fewest sub-steps that meet the target") {
    MadeUp cloth;
    const Trial best = found({.target = 0.026, .target_stretch = {}, .budget_seconds = {}}, cloth, 200);
    CHECK(best.settings.limiting.parameters.sub_steps == 8);
    CHECK(best.settings.steps_per_frame == 1);
    CHECK(best.settings.limiting.parameters.regularization == 1.2f);
    CHECK(best.settings.limiting.parameters.stepping == Stepping::whole_step);  // small steps would do no better
    CHECK(best.settings.limiting.options.solver == Solver::conjugate_gradient);
    CHECK(best.frames == 200);
    CHECK(cloth.frames < 60 * cloth.trials);  // most trials are short
}

TEST_CASE("frames that only a whole run has make for more sub-steps") {
    MadeUp cloth{.hard_from = 150};
    const Trial best = found({.target = 0.026, .target_stretch = {}, .budget_seconds = {}}, cloth, 200);
    CHECK(best.max_area_change <= 0.026);
    CHECK(best.settings.limiting.parameters.sub_steps == 32);  // 0.6 / 26 would do, the next that is tried is 32
    CHECK(best.frames == 200);
}

TEST_CASE("within a budget the closest to a target out of reach") {
    MadeUp cloth;
    const TuningGoal goal{.target = 0.001, .target_stretch = {}, .budget_seconds = 0.0125};
    const Trial best = found(goal, cloth, 60);
    CHECK(goal.within_budget(best));
    CHECK_FALSE(goal.meets_target(best));
    CHECK(best.settings.limiting.parameters.sub_steps * best.settings.steps_per_frame ==
          10);  // what is given to start from
}

TEST_CASE("a stretch asked for brings a ceiling, low enough to meet it") {
    MadeUp cloth;
    const TuningGoal goal{.target = 0.026, .target_stretch = 1.1, .budget_seconds = {}};
    const Trial best = found(goal, cloth, 60, ten_sub_steps(), {.ceiling = true});
    CHECK(goal.meets_target(best));
    CHECK(best.settings.limiting.options.limits_stretch);
    CHECK(best.settings.limiting.options.solver == Solver::chebyshev);
    CHECK(best.settings.limiting.parameters.stretch_ceiling == 1.075f);  // 1.095 is overshot
    CHECK(best.settings.limiting.parameters.sub_steps == 8);
}

TEST_CASE("where areas alone do, a stretch asked for brings no ceiling") {
    MadeUp cloth{.free_stretch = 1.05};
    const Trial best = found({.target = 0.026, .target_stretch = 1.1, .budget_seconds = {}}, cloth, 60, ten_sub_steps(),
                             {.ceiling = true});
    CHECK_FALSE(best.settings.limiting.options.limits_stretch);
    CHECK(best.settings.limiting.parameters.sub_steps == 8);
}

TEST_CASE("a scene's ceiling stays, and what misses the stretch does not meet the target") {
    MadeUp cloth;
    LimiterSettings given = under_a_ceiling(1.1f);
    given.limiting.parameters.most_sub_steps = 20;  // fewer than some that are tried
    const TuningGoal within{.target = 0.006, .target_stretch = 1.125, .budget_seconds = {}};
    const Trial best = found(within, cloth, 60, given);
    CHECK(within.meets_target(best));
    CHECK(best.settings.limiting.parameters.stretch_ceiling == 1.1f);
    CHECK(best.settings.limiting.options.limits_stretch);
    CHECK(best.settings.limiting.parameters.sub_steps * best.settings.steps_per_frame >= 34);
    const TuningGoal beyond{.target = 0.026, .target_stretch = 1.105, .budget_seconds = {}};
    const Trial missed = found(beyond, cloth, 60, given);
    CHECK(missed.max_area_change <= beyond.target);
    CHECK_FALSE(beyond.meets_target(missed));
    CHECK(beyond.miss(missed) == Approx(1.1 * 0.1 / 0.105).epsilon(1e-6));
}

TEST_CASE("an interruption ends the search") {
    CHECK_FALSE(search_settings({}, LimiterSettings{}, {}, 60,
                                [](const auto&, int, const auto&) { return std::optional<Trial>(); }));
}

TEST_CASE("a solver that is given stays, and settings that a limiter refuses are not tried") {
    const auto solvers_tried = [](const LimiterSettings& given, const TuningFreedom& freedom) {
        std::set<Solver> tried;
        const TrialRun run = [&, cloth = MadeUp{}](const auto& settings, int count, const auto& enough) mutable {
            validate(settings.limiting.options, settings.limiting.parameters);
            tried.insert(settings.limiting.options.solver);
            return cloth(settings, count, enough);
        };
        CHECK(search_settings({.target = 0.026, .target_stretch = {}, .budget_seconds = {}}, given, freedom, 60, run));
        return tried;
    };
    LimiterSettings given = ten_sub_steps();
    CHECK(solvers_tried(given, {}) == std::set{Solver::conjugate_gradient, Solver::chebyshev});
    CHECK(solvers_tried(given, {.solver = false}) == std::set{Solver::conjugate_gradient});
    given.limiting.options.matrix = Matrix::printed;
    CHECK(solvers_tried(given, {}) == std::set{Solver::conjugate_gradient});
    given.limiting.options = {.solver = Solver::chebyshev};
    CHECK(solvers_tried(given, {.solver = false}) == std::set{Solver::chebyshev});
}

TEST_CASE("settings change nothing else in a scene") {
    const auto document = nlohmann::ordered_json::parse(
        R"({"mesh": {"grid": {}}, "time_step": 0.01, "strain_limiting": {"matrix": "consistent", )"
        R"("regularization": [1.1, 1.2]}, "frames": 3})");
    const auto settings_of = [](const nlohmann::ordered_json& scene) {
        return limiter_settings(parse_scene(nlohmann::json(scene), "scene.json"));
    };
    const LimiterSettings before = settings_of(document);
    LimiterSettings fewer = before;
    fewer.steps_per_frame = 2;
    fewer.limiting.parameters.sub_steps = 3;
    const auto changed = with_settings(document, before, fewer);
    CHECK(
        changed.dump() ==
        R"({"mesh":{"grid":{}},"time_step":0.005,"strain_limiting":{"matrix":"consistent","regularization":[1.1,1.2],)"
        R"("sub_steps":3,"tolerance":0.1,"max_iterations":50},"frames":3,"steps_per_frame":2})");
    CHECK(settings_of(changed) == fewer);

    const auto bare = nlohmann::ordered_json::parse(R"({"mesh": {"grid": {}}})");
    LimiterSettings limited = settings_of(bare);
    limited.limiting.options.limits_stretch = true;
    limited.limiting.options.solver = Solver::chebyshev;
    limited.limiting.parameters.stretch_ceiling = 1.075f;
    const auto ceiled = with_settings(bare, settings_of(bare), limited);
    CHECK(ceiled["strain_limiting"]["stretch_ceiling"] == 1.075);
    CHECK_FALSE(ceiled["strain_limiting"].contains("limits_stretch"));
    CHECK(settings_of(ceiled) == limited);

    const auto plain = nlohmann::ordered_json::parse(R"({"mesh": {"grid": {}}})");
    LimiterSettings rising;
    rising.limiting.options.warm_start_sub_steps = 4;
    rising.limiting.options.solver = Solver::chebyshev;
    rising.limiting.parameters.sub_steps = 4;
    rising.limiting.parameters.first_regularization = 1.01f;
    rising.limiting.parameters.stepping = Stepping::small_steps;
    const auto risen = with_settings(plain, settings_of(plain), rising);
    CHECK(risen["strain_limiting"]["first_regularization"] == 1.01);
    CHECK(risen["strain_limiting"]["stepping"] == "small_steps");
    CHECK(risen["strain_limiting"]["solver"] == "chebyshev");
    CHECK(risen["strain_limiting"]["warm_start_sub_steps"] == 4);
    rising.limiting.options.warm_start_sub_steps = 0;  // with it the scene would be refused
    CHECK(settings_of(with_settings(plain, settings_of(plain), rising)) == rising);
}

TEST_CASE("a scene's text is the scene, short things in one line") {
    const auto document = nlohmann::ordered_json::parse(R"({"b": [1, 2.5, "x"], "a": {"c": {}, "d": null}})");
    CHECK(scene_text(document) == "{\n  \"b\": [1, 2.5, \"x\"],\n  \"a\": {\"c\": {}, \"d\": null}\n}\n");
    nlohmann::ordered_json wide{{"long", std::vector<int>(60, 100)}, {"text", "a\"b"}};
    CHECK(nlohmann::ordered_json::parse(scene_text(wide)) == wide);
    CHECK(scene_text(wide).find("\n    100,\n") != std::string::npos);
}
