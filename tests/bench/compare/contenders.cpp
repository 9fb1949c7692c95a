// SPDX-License-Identifier: MIT
#include "compare/contenders.hpp"

#include "run/input_error.hpp"

#include <catch2/catch.hpp>
#include <set>

using namespace apsl;
using namespace apsl::compare;

namespace {

const nlohmann::json kScene = nlohmann::json::parse(R"({
    "mesh": {"grid": {}}, "time_step": 0.02, "steps_per_frame": 2,
    "integrator": {"implicit_springs": {"stretch_stiffness": 5}}, "strain_limiting": {"sub_steps": 7}})");

PreparedScene prepared(const std::string& method, const KnobValues& knobs) {
    return prepare_scene(find_contender(method), kScene, "scene.json", knobs);
}

}  // namespace

TEST_CASE("contenders have names of their own, ours and every rival among them") {
    std::set<std::string> names;
    for (const Contender& contender : contenders()) names.insert(contender.name);
    CHECK(names.size() == contenders().size());
    CHECK(names.count("apsl") == 1);
    for (const methods::MethodInfo& method : methods::all_methods()) CHECK(names.count(method.name) == 1);
    CHECK_THROWS_WITH(find_contender("nothing"), Catch::Contains("unknown method \"nothing\", expected one of none"));
}

TEST_CASE("every standard sweep is legal and made of different runs") {
    for (const Contender& contender : contenders()) {
        CAPTURE(contender.name);
        std::set<std::string> runs;
        for (const KnobValues& knobs : standard_sweep(contender)) {
            runs.insert(prepare_scene(contender, kScene, "scene.json", knobs).knobs.dump());
        }
        CHECK_FALSE(runs.empty());
        CHECK(runs.size() == standard_sweep(contender).size());
    }
}

TEST_CASE("only ours keep the strain limiting, with the scene's own values where none are given") {
    CHECK_FALSE(prepared("none", {}).document.contains("strain_limiting"));
    const PreparedScene ours = prepared("apsl", {{"strain_limiting.regularization", 1.05}});
    CHECK(ours.document["strain_limiting"]["matrix"] == "consistent");
    CHECK(ours.document["strain_limiting"]["regularization"] == 1.05);
    CHECK(ours.knobs["strain_limiting.sub_steps"] == 7);
    CHECK(ours.knobs["strain_limiting.tolerance"] == 0.1);
    CHECK(prepared("apsl_printed", {}).document["strain_limiting"]["matrix"] == "printed");
}

TEST_CASE("the library's defaults stand in for whatever the scene sets") {
    CHECK(prepared("apsl_defaults", {}).document["strain_limiting"] == nlohmann::json::object());
}

TEST_CASE("a frame keeps its length whatever its steps") {
    const PreparedScene small_steps = prepared("none", {{"steps_per_frame", 8}});
    CHECK(small_steps.document["steps_per_frame"] == 8);
    CHECK(small_steps.document["time_step"].get<double>() == Approx(0.005));
    CHECK(small_steps.knobs["steps_per_frame"] == 8);
    CHECK(prepared("none", {}).knobs["steps_per_frame"] == 2);
}

TEST_CASE("stiff springs are the scene's, times a factor") {
    const PreparedScene stiff = prepared("springs", {{"stretch_stiffness_factor", 30}});
    CHECK(stiff.document["integrator"]["implicit_springs"]["stretch_stiffness"] == 150.0);
    nlohmann::json stand_alone = kScene;
    stand_alone["integrator"] = {{"stand_alone", nlohmann::json::object()}};
    CHECK_THROWS_AS(prepare_scene(find_contender("springs"), stand_alone, "scene.json", {}), scenes::InputError);
}

TEST_CASE("lists of values make every combination") {
    const std::vector<KnobValues> all = combinations({{"a", {1, 2}}, {"b", {3, 4, 5}}, {"c", 6}});
    REQUIRE(all.size() == 6);
    CHECK(all.front() == KnobValues{{"a", 1}, {"b", 3}, {"c", 6}});
    CHECK(all.back() == KnobValues{{"a", 2}, {"b", 5}, {"c", 6}});
}

TEST_CASE("knobs that a method does not have or take are named") {
    const auto refused = [](const std::string& method, const KnobValues& knobs, const std::string& what) {
        CHECK_THROWS_WITH(check_knobs(find_contender(method), knobs), Catch::Contains(what));
    };
    refused("none", {{"sub_steps", 1}}, "none: unknown knob \"sub_steps\", expected one of steps_per_frame");
    refused("apsl", {{"density", 1}}, "a path below strain_limiting or integrator");
    refused("apsl", {{"strain_limiting.regularization", 0.5}}, "expected a number ≥ 1");
    refused("springs", {{"stretch_stiffness_factor", "stiff"}}, "is \"stiff\", expected a number ≥ 0");
    CHECK_NOTHROW(check_knobs(find_contender("apsl"), {{"strain_limiting.max_iterations", 9}}));
}
