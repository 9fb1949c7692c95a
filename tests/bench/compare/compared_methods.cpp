// SPDX-License-Identifier: MIT
#include "compare/compared_methods.hpp"

#include "run/input_error.hpp"

#include <catch2/catch.hpp>
#include <set>

using namespace apsl;
using namespace apsl::compare;

namespace {

const nlohmann::json scene_text = nlohmann::json::parse(R"({
    "mesh": {"grid": {}}, "time_step": 0.02, "steps_per_frame": 2,
    "integrator": {"implicit_springs": {"stretch_stiffness": 5}}, "strain_limiting": {"sub_steps": 7}})");

PreparedScene prepared(const std::string& method, const ParameterValues& parameters) {
    return prepare_scene(find_method(method), scene_text, "scene.json", parameters);
}

}  // namespace

TEST_CASE("methods have names of their own, ours and every baseline among them") {
    std::set<std::string> names;
    for (const ComparedMethod& method : compared_methods()) names.insert(method.name);
    CHECK(names.size() == compared_methods().size());
    CHECK(names.count("apsl") == 1);
    for (const methods::MethodInfo& method : methods::all_methods()) CHECK(names.count(method.name) == 1);
    CHECK_THROWS_WITH(find_method("nothing"), Catch::Contains("unknown method \"nothing\", expected one of none"));
}

TEST_CASE("every standard sweep is legal and made of different runs") {
    for (const ComparedMethod& method : compared_methods()) {
        CAPTURE(method.name);
        std::set<std::string> runs;
        for (const ParameterValues& parameters : standard_sweep(method))
            runs.insert(prepare_scene(method, scene_text, "scene.json", parameters).parameters.dump());
        CHECK_FALSE(runs.empty());
        CHECK(runs.size() == standard_sweep(method).size());
    }
}

TEST_CASE("only ours keep the strain limiting, with the scene's own values where none are given") {
    CHECK_FALSE(prepared("none", {}).document.contains("strain_limiting"));
    const PreparedScene ours = prepared("apsl", {{"strain_limiting.regularization", 1.05}});
    CHECK(ours.document["strain_limiting"]["matrix"] == "consistent");
    CHECK(ours.document["strain_limiting"]["regularization"] == 1.05);
    CHECK(ours.parameters["strain_limiting.sub_steps"] == 7);
    CHECK(ours.parameters["strain_limiting.tolerance"] == 0.1);
    CHECK(prepared("apsl_printed", {}).document["strain_limiting"]["matrix"] == "printed");
}

TEST_CASE("the library's defaults stand in for whatever the scene sets") {
    CHECK(prepared("apsl_defaults", {}).document["strain_limiting"] == nlohmann::json::object());
}

TEST_CASE("a frame keeps its length whatever its steps") {
    const PreparedScene small_steps = prepared("none", {{"steps_per_frame", 8}});
    CHECK(small_steps.document["steps_per_frame"] == 8);
    CHECK(small_steps.document["time_step"].get<double>() == Approx(0.005));
    CHECK(small_steps.parameters["steps_per_frame"] == 8);
    CHECK(prepared("none", {}).parameters["steps_per_frame"] == 2);
}

TEST_CASE("stiff springs are the scene's, times a factor") {
    const PreparedScene stiff = prepared("springs", {{"stretch_stiffness_factor", 30}});
    CHECK(stiff.document["integrator"]["implicit_springs"]["stretch_stiffness"] == 150.0);
    nlohmann::json stand_alone = scene_text;
    stand_alone["integrator"] = {{"stand_alone", nlohmann::json::object()}};
    CHECK_THROWS_AS(prepare_scene(find_method("springs"), stand_alone, "scene.json", {}), scenes::InputError);
}

TEST_CASE("a stand-alone scene is a step of our limiter, which no other method takes") {
    nlohmann::json stand_alone = scene_text;
    stand_alone["integrator"] = {{"stand_alone", nlohmann::json::object()}};
    for (const char* other : {"none", "springs", "pbd_edges", "apsl_direct"}) {
        CAPTURE(other);
        CHECK_THROWS_WITH(prepare_scene(find_method(other), stand_alone, "scene.json", {}),
                          Catch::Contains(std::string("scene.json: ") + other + ": expected a scene whose integrator"));
    }
    CHECK(prepare_scene(find_method("apsl_ceiling"), stand_alone, "scene.json", {}).document["integrator"] ==
          stand_alone["integrator"]);
}

TEST_CASE("ours stand-alone needs no scene that is") {
    const PreparedScene alone = prepared("apsl_stand_alone", {{"strain_limiting.sub_steps", 20}});
    CHECK(alone.document["integrator"] == nlohmann::json{{"stand_alone", {{"tethers", 0.0}}}});
    CHECK(prepared("apsl_tethers", {}).document["integrator"] == nlohmann::json{{"stand_alone", {{"tethers", 1.0}}}});
    CHECK(alone.document["strain_limiting"]["stretch_ceiling"] == 1.1);
    CHECK(alone.document["strain_limiting"]["sub_steps"] == 20);
}

TEST_CASE("tethers stand in the integrator's place, whatever that is, and know no colliders") {
    nlohmann::json scene = scene_text;
    for (const char* integrator : {"implicit_springs", "stand_alone"}) {
        scene["integrator"] = {{integrator, nlohmann::json::object()}};
        const PreparedScene tethers = prepare_scene(find_method("tethers"), scene, "scene.json", {{"small_steps", 40}});
        CHECK(tethers.document["integrator"] == nlohmann::json{{"none", nlohmann::json::object()}});
        CHECK_FALSE(tethers.document.contains("strain_limiting"));
        CHECK(tethers.parameters["small_steps"] == 40);
        CHECK(tethers.parameters["tether_length"] == 1);
        CHECK(prepare_scene(find_method("pbd_small_steps"), scene, "scene.json", {}).parameters["tether_length"] == 0);
    }
    scene["colliders"] = nlohmann::json::array({{{"floor", nlohmann::json::object()}}});
    CHECK_THROWS_WITH(prepare_scene(find_method("tethers"), scene, "scene.json", {}),
                      "scene.json: tethers: expected a scene without colliders");
}

TEST_CASE("lists of values make every combination") {
    const std::vector<ParameterValues> all = combinations({{"a", {1, 2}}, {"b", {3, 4, 5}}, {"c", 6}});
    REQUIRE(all.size() == 6);
    CHECK(all.front() == ParameterValues{{"a", 1}, {"b", 3}, {"c", 6}});
    CHECK(all.back() == ParameterValues{{"a", 2}, {"b", 5}, {"c", 6}});
}

TEST_CASE("parameters that a method does not have or take are named") {
    const auto refused = [](const std::string& method, const ParameterValues& parameters, const std::string& what) {
        CHECK_THROWS_WITH(check_parameters(find_method(method), parameters), Catch::Contains(what));
    };
    refused("none", {{"sub_steps", 1}}, "none: unknown parameter \"sub_steps\", expected one of steps_per_frame");
    refused("apsl", {{"density", 1}}, "a path below strain_limiting or integrator");
    refused("apsl", {{"strain_limiting.regularization", 0.5}}, "expected a number ≥ 1");
    refused("springs", {{"stretch_stiffness_factor", "stiff"}}, "is \"stiff\", expected a number ≥ 0");
    CHECK_NOTHROW(check_parameters(find_method("apsl"), {{"strain_limiting.max_iterations", 9}}));
}
