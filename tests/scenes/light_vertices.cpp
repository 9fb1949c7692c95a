// SPDX-License-Identifier: MIT
// Vertices too light for their neighbours, and triangles that a call leaves worse: what is told of them.
#include "run/light_vertices.hpp"

#include "run/parse_scene.hpp"
#include "run/simulation.hpp"
#include "run/summary.hpp"
#include "scenes/sample_files.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace apsl;
using namespace apsl::scenes;
using apsl::test::TemporaryFolder;

namespace {

Scene parse(const std::string& text) {
    return parse_scene(nlohmann::json::parse(text), "scene.json");
}

// 5 × 5 vertices, 0.25 m apart; vertex 12 is the middle one, with eight triangles four times the median mass.
Scene grid_with(const std::string& more) {
    return parse(R"({"mesh": {"grid": {"vertices": [5, 5], "size": [1, 1]}})" + more + "}");
}

RunReport report_of(Simulation& simulation, const LightVertices& light, int frames) {
    RunReport report;
    report.backend = "reference";
    report.vertices = simulation.cloth().topology->vertex_count();
    report.light = light;
    for (int frame = 0; frame < frames; ++frame) report.frames.push_back(simulation.run_frame());
    return report;
}

}  // namespace

TEST_CASE("a vertex below 1/30 of the median mass is light, one above is not") {
    const auto with_factor = [](const std::string& factor) {
        return make_scene_cloth(grid_with(R"(, "masses": [{"vertices": [12], "factor": )" + factor + "}]"));
    };
    const SceneCloth light = with_factor("0.005");
    CHECK(light.light.count == 1);
    CHECK(light.light.lightest == 12);
    CHECK(light.light.share_of_median == Approx(0.02));
    CHECK_FALSE(light.light.shorter_than);  // all edges are as long
    REQUIRE(light.warnings.size() == 1);
    CHECK(light.warnings[0] ==
          "scene.json: mesh: movable vertices with less than 1/30 of the median mass: 1 (lightest: vertex 12, 1/50 of "
          "the median mass); they give way to every force, give them more mass");
    const SceneCloth ordinary = with_factor("0.0125");
    CHECK(ordinary.light.count == 0);
    CHECK(ordinary.light.lightest == 12);
    CHECK(ordinary.warnings.empty());
}

TEST_CASE("a pinned vertex is never light") {
    const SceneCloth cloth = make_scene_cloth(
        grid_with(R"(, "pins": [{"vertices": [12]}], "masses": [{"vertices": [12], "factor": 0.001}])"));
    CHECK(cloth.light.count == 0);
    CHECK(cloth.light.lightest != 12);
    const SceneCloth all_pinned =
        make_scene_cloth(parse(R"({"mesh": {"grid": {"vertices": [2, 2]}}, "pins": [{"vertices": [0, 1, 2, 3]}]})"));
    CHECK(all_pinned.light.count == 0);
}

TEST_CASE("light vertices go with edges below a length that is told") {
    // Three squares in a row, and at a corner a flap of 1 mm by 2 mm.
    const TemporaryFolder folder;
    const std::string file = folder.write("flap.obj",
                                          "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 3 1 0\n"
                                          "v -0.001 0 0\nv 0 -0.002 0\n"
                                          "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 1 9 10\n");
    Scene scene;
    scene.mesh = MeshFile{.file = file, .height = {}};
    const SceneCloth cloth = make_scene_cloth(scene);
    CHECK(cloth.light.count == 2);
    CHECK(cloth.light.lightest == 8);
    // Vertex 8's shortest edge has 1 mm, vertex 9's 2 mm: with both below the length, both go.
    REQUIRE(cloth.light.shorter_than);
    CHECK(*cloth.light.shorter_than == Approx(0.0021));
    CHECK(light_vertices_advice(cloth.light) == "collapse edges under 2.1 mm, or give them more mass");
}

TEST_CASE("a run tells which masses the filter raised, and what to do") {
    const Scene scene = grid_with(
        R"(, "pins": [{"corners": ["min_x_min_z", "max_x_min_z"]}], "masses": [{"vertices": [12], "factor": 0.00001}],
           "strain_limiting": {}, "frames": 20)");
    SceneCloth cloth = make_scene_cloth(scene);
    const LightVertices light = cloth.light;
    FilterStage filter = make_filter_stage(scene, cloth.state, Backend::reference, std::nullopt, false);
    Simulation simulation(scene, std::move(cloth), std::move(filter), false);
    const RunReport report = report_of(simulation, light, 20);
    const RunSummary summary = summarize(report.frames);
    REQUIRE(summary.raised_vertices >= 1);
    CHECK(summary.greatest_mass_ratio > 1.0);
    const std::string text = summary_text(report);
    CAPTURE(text);
    CHECK_THAT(text,
               Catch::Contains(" of 25 too light for the tension at their triangles (lightest: vertex 12, 1/50000 of "
                               "the median mass); the filter raised their mass up to "));
    const nlohmann::json json = to_json(report);
    CHECK(json["light_vertices"] ==
          nlohmann::json{{"count", 1}, {"lightest", 12}, {"share_of_median_mass", light.share_of_median}});
    CHECK(json["summary"]["raised_vertices"] == summary.raised_vertices);
    CHECK(json["summary"]["greatest_mass_ratio"] == summary.greatest_mass_ratio);
}

TEST_CASE("statistics of a frame are the greatest of its steps, and a triangle that got worse is named") {
    const Scene scene = grid_with(R"(, "steps_per_frame": 3)");
    SceneCloth cloth = make_scene_cloth(scene);
    const LightVertices light = cloth.light;
    int calls = 0;
    CustomFilter filter{"stub", "none", [&calls](ClothState&) {
                            Stats stats{};
                            stats.greatest_mass_ratio = 1.0f;
                            ++calls;
                            if (calls == 2) {
                                stats.raised_vertices = 7;
                                stats.greatest_mass_ratio = 230.0f;
                            }
                            if (calls == 4 || calls == 5) {
                                stats.status = Status::worsened;
                                stats.offender = Offender::triangle;
                                stats.offender_index = calls == 4 ? 3 : 4;
                                stats.max_area_change = calls == 4 ? 0.5f : 0.25f;
                                stats.initial_max_area_change = 0.125f;
                            }
                            if (calls == 7) stats.status = Status::worsened;  // the velocities stand as given
                            return stats;
                        }};
    Simulation simulation(scene, std::move(cloth), std::move(filter), false);
    RunReport report = report_of(simulation, light, 3);
    CHECK(report.frames[0].raised_vertices == 7);
    CHECK(report.frames[0].greatest_mass_ratio == 230.0);
    CHECK_FALSE(report.frames[0].worsened);
    CHECK(report.frames[1].raised_vertices == 0);
    CHECK(report.frames[1].greatest_mass_ratio == 1.0);
    CHECK_FALSE(report.frames[2].worsened);
    const nlohmann::json json = to_json(report);
    const nlohmann::json worsened = {
        {"frame", 1}, {"step", 0}, {"triangle", 3}, {"area_change", 0.5}, {"initial_area_change", 0.125}};
    CHECK(json["frames"][1]["worsened"] == worsened);
    CHECK(json["summary"]["worsened"] == worsened);
    CHECK_FALSE(json["frames"][0].contains("worsened"));
    CHECK(json["frames"][0]["raised_vertices"] == 7);
    CHECK(json["summary"]["greatest_mass_ratio"] == 230.0);
    CHECK_THAT(
        summary_text(report),
        Catch::Contains("worsened               triangle 3 in frame 1: area off by 50.00 %, where the greatest was "
                        "12.50 % before the filter; the rest of the cloth keeps its correction"));
    report.frames.erase(report.frames.begin(), report.frames.begin() + 2);
    CHECK_THAT(summary_text(report), !Catch::Contains("worsened               triangle") && !Catch::Contains("light"));
}
