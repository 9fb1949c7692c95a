// SPDX-License-Identifier: MIT
// What a user finds on the first day: devices, help, the project's scenes, meshes of one's own.
#include "scenes/program_run.hpp"
#include "scenes/sample_files.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

using namespace apsl::test;

TEST_CASE("devices are listed with their numbers, the version and a short help are there") {
    const ProgramRun devices = run_apsl("devices");
    CHECK(devices.exit_code == 0);
    CHECK_THAT(devices.output, Catch::StartsWith("0  ") && Catch::Contains("compute units"));
    CHECK(devices.output == run_apsl("devices").output);
    CHECK_THAT(run_apsl("--version").output, Catch::StartsWith("apsl "));
    for (const std::string arguments : {"--help", "run --help", "validate --help"}) {
        const ProgramRun help = run_apsl(arguments);
        CHECK(help.exit_code == 0);
        CHECK(std::count(help.output.begin(), help.output.end(), '\n') <= 24);
        std::size_t line = 0;
        for (const char letter : help.output) {
            line = letter == '\n' ? 0 : line + 1;
            CHECK(line <= 80);
        }
    }
}

TEST_CASE("every scene of the project is valid and runs") {
    const std::string scene =
        GENERATE("curtain.json", "curtain_unfiltered.json", "sphere_drape.json", "stand_alone_curtain.json",
                 "pushed_curtain.json", "twist.json", "skirt.json", "paper_fig1.json", "paper_fig6.json");
    CAPTURE(scene);
    const ProgramRun validated = run_apsl("validate " + scene_path(scene));
    CHECK(validated.exit_code == 0);
    CHECK(validated.errors.empty());
    const ProgramRun run = run_apsl("run --frames 2 " + scene_path(scene));
    CAPTURE(run.errors);
    CHECK(run.exit_code == 0);
}

TEST_CASE("garments run by path") {
    const std::string meshes = APSL_MESHES;
    if (!std::filesystem::is_directory(meshes)) {
        WARN("../shared/meshes is not there: the garments are passed over");
        return;
    }
    const std::string file = GENERATE("tshirt.obj", "skirt.obj");
    const TemporaryFolder folder;
    const std::string report_file = (folder.path() / "report.json").string();
    CAPTURE(file);
    const ProgramRun run = run_apsl(
        "run " + scene_path("skirt.json") + " --frames 10 --set mesh.file=" + meshes + "/" + file +
        " --set mesh.height=1 --set 'pins=[{\"corners\":[\"min_x_max_y\",\"max_x_max_y\"]}]' --report " + report_file);
    CAPTURE(run.errors);
    CHECK(run.exit_code == 0);
    const nlohmann::json report = nlohmann::json::parse(read_bytes(report_file));
    CHECK(report["triangles"] == (file == "tshirt.obj" ? 3726 : 4925));
    CHECK(report["vertices"] == (file == "tshirt.obj" ? 1921 : 2565));
    CHECK(report["frames"].size() == 10);
    CHECK(report["needle_triangles"]["count"] == 0);
    CHECK(report["needle_triangles"]["shortest_over_longest_edge"] > 0.2);
}
