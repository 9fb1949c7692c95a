// SPDX-License-Identifier: MIT
#include "compare/study.hpp"

#include "run/input_error.hpp"
#include "scenes/sample_files.hpp"

#include <catch2/catch.hpp>

using namespace apsl;
using namespace apsl::compare;

namespace {

const std::string scene_text = R"({"mesh": {"grid": {"vertices": [3, 3]}}, "frames": 9})";

}  // namespace

TEST_CASE("a study names scenes with changes, methods with parameters, and conditions") {
    const test::TemporaryFolder folder;
    folder.write("flag.json", scene_text);
    const std::string file = folder.write("study.json", R"({
        "scenes": [{"file": "flag.json"}, {"file": "flag.json", "name": "heavy", "set": {"density": 2, "frames": 5}}],
        "methods": ["none", {"name": "apsl", "parameters": {"strain_limiting.sub_steps": [1, 2], "steps_per_frame": 3}}],
        "deviation": {"frames": [4], "step_factor": 2},
        "run_seconds": 7, "rounds": 3})");
    const Study study = read_study(file, {"frames=6"});
    REQUIRE(study.scenes.size() == 2);
    CHECK(study.scenes[0].name == "flag");
    CHECK(study.scenes[1].name == "heavy");
    CHECK(study.scenes[1].document["density"] == 2);
    CHECK(study.scenes[1].document["frames"] == 6);
    REQUIRE(study.methods.size() == 2);
    CHECK(study.methods[1].parameters.size() == 2);
    CHECK(study.methods[1].parameters[1] == ParameterValues{{"steps_per_frame", 3}, {"strain_limiting.sub_steps", 2}});
    CHECK(study.deviation->frames == std::vector<int>{4});
    CHECK(study.deviation->converged.step_factor == 2);
    CHECK(study.run_seconds == 7.0);
    CHECK(study.rounds == 3);
}

TEST_CASE("what is wrong in a study is named with its place") {
    const test::TemporaryFolder folder;
    folder.write("flag.json", scene_text);
    const auto refused = [&](const std::string& text, const std::string& what) {
        const std::string file = folder.write("study.json", text);
        CHECK_THROWS_WITH(read_study(file, {}), Catch::Contains(what));
        CHECK_THROWS_AS(read_study(file, {}), scenes::InputError);
    };
    refused("[", "not valid JSON");
    refused(R"({"scene": []})", "scene: unknown key");
    refused(R"({"scenes": [{}]})", "scenes[0]: file is missing");
    refused(R"({"scenes": [{"file": "none.json"}]})", "none.json: no such scene file");
    refused(R"({"scenes": [{"file": "flag.json", "set": {"density": -1}}]})", "density: expected a number > 0");
    refused(R"({"methods": ["none", {"name": "apsl", "parameters": {"color": 1}}]})",
            "methods[1].parameters: apsl: unknown parameter");
    refused(R"({"methods": ["wishing"]})", "unknown method \"wishing\"");
    refused(R"({"deviation": {"frames": [-1]}})", "deviation.frames[0]: expected a whole number");
    refused(R"({"rounds": 0})", "rounds: expected a whole number from 1 to 1000");
    refused(R"({"run_seconds": 0})", "run_seconds: expected a number > 0");
}
