// SPDX-License-Identifier: MIT
// What a run leaves behind: report, frames, exit code.
#include "scenes/program_run.hpp"
#include "scenes/sample_files.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

using namespace apsl::test;

namespace {

nlohmann::json read_json(const std::filesystem::path& file) {
    return nlohmann::json::parse(read_bytes(file));
}

std::set<std::string> keys(const nlohmann::json& object) {
    std::set<std::string> names;
    for (const auto& [key, unused] : object.items()) names.insert(key);
    return names;
}

bool contains(const std::set<std::string>& all, const std::set<std::string>& some) {
    return std::includes(all.begin(), all.end(), some.begin(), some.end());
}

// Everything but times.
nlohmann::json without_seconds(nlohmann::json report) {
    const auto take_out = [](nlohmann::json& object) {
        for (const std::string& key : keys(object))
            if (key.find("seconds") != std::string::npos) object.erase(key);
    };
    for (nlohmann::json& frame : report["frames"]) take_out(frame);
    take_out(report["summary"]);
    return report;
}

std::set<std::string> file_names(const std::filesystem::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.insert(entry.path().filename().string());
    return names;
}

}  // namespace

TEST_CASE("a run leaves a whole report and frames that belong to it") {
    const TemporaryFolder folder;
    const std::filesystem::path out = folder.path() / "new" / "out";
    const std::filesystem::path report_file = folder.path() / "report.json";
    const ProgramRun run = run_apsl("run " + scene_path("curtain.json") + " --frames 3 --out " + out.string() +
                                    " --report " + report_file.string());
    CAPTURE(run.errors);
    REQUIRE(run.exit_code == 0);
    CHECK_THAT(run.output, Catch::Contains("greatest area change"));
    CHECK_THAT(run.output, Catch::Contains("RMS area change"));
    CHECK_THAT(run.output, Catch::Contains("strain limiting"));
    CHECK(file_names(out) == std::set<std::string>{"cloth.obj", "cloth.pc2", "cloth.pvd", "frame_0000.vtp",
                                                   "frame_0001.vtp", "frame_0002.vtp", "report.json"});
    CHECK(read_bytes(out / "report.json") == read_bytes(report_file));

    const nlohmann::json report = read_json(report_file);
    CHECK(contains(keys(report), {"scene", "backend", "device", "vertices", "triangles", "stages", "device_bytes",
                                  "frames", "summary", "kernels"}));
    CHECK(report["scene"] == scene_path("curtain.json"));
    CHECK(report["backend"] == "opencl");
    CHECK(report["vertices"] == 4225);
    CHECK(report["triangles"] == 8192);
    CHECK(report["stages"] == nlohmann::json::array({"implicit_springs", "strain_limiting"}));
    // At least the caller's own buffers: two vectors a vertex, a mass a vertex, an area a triangle.
    CHECK(report["device_bytes"] > 4 * (7 * 4225 + 8192));
    REQUIRE(report["frames"].size() == 3);
    double greatest = 0.0;
    double sum = 0.0;
    int iterations = 0;
    for (int k = 0; k < 3; ++k) {
        const nlohmann::json& frame = report["frames"][k];
        CHECK(contains(keys(frame), {"frame", "max_area_change", "rms_area_change", "max_edge_stretch",
                                     "min_edge_stretch", "max_principal_stretch", "max_speed", "energy", "sub_steps",
                                     "iterations", "filter_seconds", "step_seconds", "status"}));
        CHECK(frame["frame"] == k);
        CHECK(frame["sub_steps"] == 10);
        CHECK(frame["status"] == "ok");
        CHECK(frame["max_area_change"] >= frame["rms_area_change"]);
        CHECK(frame["max_area_change"] > 0.0);
        CHECK(frame["step_seconds"] > frame["filter_seconds"]);
        CHECK(frame["max_speed"] > 0.0);
        const nlohmann::json& energy = frame["energy"];
        CHECK(energy["gravity"] < 0.0);  // it falls from where it rested
        CHECK(energy["total"].get<double>() ==
              Approx(energy["kinetic"].get<double>() + energy["gravity"].get<double>() +
                     energy["springs"].get<double>()));
        greatest = std::max(greatest, frame["max_area_change"].get<double>());
        sum += frame["max_area_change"].get<double>();
        iterations += frame["iterations"].get<int>();
    }
    CHECK(report["start_energy"]["total"] == 0.0);
    const nlohmann::json& summary = report["summary"];
    CHECK(summary["max_area_change"] == greatest);
    CHECK(summary["mean_max_area_change"].get<double>() == Approx(sum / 3.0));
    CHECK(summary["iterations_per_solve"].get<double>() == Approx(iterations / 30.0));
    CHECK(summary["status"] == "ok");
    CHECK(contains(keys(summary), {"rms_area_change", "max_edge_stretch", "max_principal_stretch",
                                   "filter_seconds_per_frame", "step_seconds_per_frame"}));
}

TEST_CASE("the point cache holds every vertex of every frame, and the OBJ the cloth at rest") {
    const TemporaryFolder folder;
    REQUIRE(run_apsl("run " + scene_path("curtain_unfiltered.json") +
                     " --set mesh.grid.vertices=[5,7] --set pins=[] --frames 4 --out " + folder.path().string())
                .exit_code == 0);
    const std::string cache = read_bytes(folder.path() / "cloth.pc2");
    REQUIRE(cache.size() == 32 + 4 * 35 * 3 * sizeof(float));
    CHECK(cache.substr(0, 12) == std::string("POINTCACHE2\0", 12));
    std::array<std::int32_t, 5> header{};
    std::memcpy(header.data(), cache.data() + 12, 20);
    CHECK(header[0] == 1);
    CHECK(header[1] == 35);
    CHECK(header[4] == 4);
    // An unpinned cloth falls freely: with backward Euler and damping d, v ← (v − g Δt) / (1 + d Δt).
    double velocity = 0.0;
    double height = 0.0;
    for (int frame = 0; frame < 4; ++frame) {
        velocity = (velocity - 9.81 * 0.016666667) / (1.0 + 0.5 * 0.016666667);
        height += velocity * 0.016666667;
        float y = 0.0f;
        std::memcpy(&y, cache.data() + 32 + (static_cast<std::size_t>(frame) * 105 + 3 * 34 + 1) * sizeof y, sizeof y);
        CHECK(y == Approx(height));
    }
    const std::string obj = read_bytes(folder.path() / "cloth.obj");
    CHECK(obj.starts_with("v -0.5 0 -0.5\nv -0.25 0 -0.5\n"));
    CHECK(std::count(obj.begin(), obj.end(), 'v') == 35);
    CHECK(std::count(obj.begin(), obj.end(), 'f') == 48);
}

TEST_CASE("two runs leave the same bytes, times apart") {
    const TemporaryFolder folder;
    const std::string backend = GENERATE("opencl", "reference");
    for (const std::string name : {"first", "second"}) {
        REQUIRE(run_apsl("run " + scene_path("curtain.json") + " --frames 12 --backend " + backend + " --out " +
                         (folder.path() / name).string())
                    .exit_code == 0);
    }
    const std::set<std::string> names = file_names(folder.path() / "first");
    CHECK(names.size() == 12 + 4);
    for (const std::string& name : names) {
        if (name == "report.json") continue;
        CAPTURE(name);
        CHECK(read_bytes(folder.path() / "first" / name) == read_bytes(folder.path() / "second" / name));
    }
    CHECK(without_seconds(read_json(folder.path() / "first" / "report.json")) ==
          without_seconds(read_json(folder.path() / "second" / "report.json")));
}

TEST_CASE("a shorter run into the same folder leaves nothing of the longer one") {
    const TemporaryFolder folder;
    const std::string command = "run " + scene_path("curtain_unfiltered.json") +
                                " --set mesh.grid.vertices=[5,5] --set pins=[] --out " + folder.path().string();
    folder.write("notes.txt", "kept");
    REQUIRE(run_apsl(command + " --frames 5").exit_code == 0);
    REQUIRE(run_apsl(command + " --frames 2").exit_code == 0);
    CHECK(file_names(folder.path()) == std::set<std::string>{"cloth.obj", "cloth.pc2", "cloth.pvd", "frame_0000.vtp",
                                                             "frame_0001.vtp", "notes.txt", "report.json"});
}

TEST_CASE("a scene without strain limiting needs no OpenCL at all") {
    const TemporaryFolder folder;
    const std::string report_file = (folder.path() / "report.json").string();
    const ProgramRun run =
        run_apsl("run " + scene_path("curtain_unfiltered.json") + " --frames 2 --report " + report_file,
                 "OCL_ICD_VENDORS=" + folder.path().string());
    CAPTURE(run.errors);
    REQUIRE(run.exit_code == 0);
    const nlohmann::json report = read_json(report_file);
    CHECK(report["backend"] == "none");
    CHECK(report["stages"] == nlohmann::json::array({"implicit_springs"}));
    CHECK(report["device_bytes"] == 0);
    CHECK(report["frames"][0]["sub_steps"] == 0);
    CHECK(report["frames"][1]["max_area_change"] > 0.0);
}

TEST_CASE("only a profiled run lists kernels") {
    const TemporaryFolder folder;
    const std::string report_file = (folder.path() / "report.json").string();
    const std::string command = "run " + scene_path("curtain.json") + " --frames 2 --report " + report_file;
    REQUIRE(run_apsl(command).exit_code == 0);
    CHECK(read_json(report_file)["kernels"].empty());
    REQUIRE(run_apsl(command + " --profile").exit_code == 0);
    const nlohmann::json kernels = read_json(report_file)["kernels"];
    REQUIRE_FALSE(kernels.empty());
    for (const nlohmann::json& kernel : kernels) {
        CHECK(kernel["launches"] > 0);
        CHECK(kernel["seconds"] > 0.0);
    }
}

TEST_CASE("an interrupted run says so and leaves nothing that names itself whole") {
    const TemporaryFolder folder;
    // `timeout` stands in for the user's Ctrl-C. In the foreground it signals the program alone: otherwise it signals
    // the whole group as well, and a second signal, where it arrives as a second one, ends the program at once.
    const ProgramRun run = run_apsl("run " + scene_path("curtain_unfiltered.json") + " --frames 1000000 --out " +
                                        folder.path().string() + " --report " + (folder.path() / "r.json").string(),
                                    "timeout --foreground --signal=INT 3");
    CHECK_THAT(run.errors, Catch::Contains("interrupted after "));
    const std::set<std::string> names = file_names(folder.path());
    CHECK(names.count("frame_0000.vtp") == 1);
    for (const std::string& name : names) {
        CAPTURE(name);
        CHECK((name == "cloth.obj" || (name.starts_with("frame_") && name.ends_with(".vtp"))));
    }
}

TEST_CASE("an interrupted run exits with what shells have for its signal") {
    const auto [signal, code] = GENERATE(table<std::string, int>({{"INT", 130}, {"TERM", 143}, {"HUP", 129}}));
    CAPTURE(signal);
    // With its status preserved `timeout` passes on the program's own exit code.
    // These tests may run under nohup.
    const ProgramRun run =
        run_apsl("run " + scene_path("curtain_unfiltered.json") + " --frames 1000000",
                 "env --default-signal=HUP timeout --foreground --preserve-status --signal=" + signal + " 2");
    CHECK(run.exit_code == code);
    CHECK_THAT(run.errors, Catch::Contains("interrupted after "));
}

TEST_CASE("a run under nohup goes on when its terminal is closed") {
    const ProgramRun run = run_apsl("run " + scene_path("curtain_unfiltered.json") + " --frames 1000000",
                                    "timeout --foreground --preserve-status --signal=HUP --kill-after=1 2 nohup");
    CHECK(run.exit_code == 137);
    CHECK_THAT(run.errors, !Catch::Contains("interrupted after "));
}

TEST_CASE("a run into the folder of a run that is at work is refused, until that has ended") {
    const TemporaryFolder folder;
    const std::string out = (folder.path() / "out").string();
    const std::string run = "run " + scene_path("curtain_unfiltered.json") + " --out " + out + " --frames ";
    const ProgramRun second = run_apsl(run + "1000000 2>&1 & until [ -e " + out + "/cloth.obj ]; do sleep 0.1; done; " +
                                           APSL_PROGRAM " " + run + "1; code=$?; kill -TERM $!; wait $!; exit $code)",
                                       "(");
    CHECK(second.exit_code == 2);
    CHECK(second.errors == "error: " + out + ": another run writes there, expected a folder of its own for each\n");
    CHECK_THAT(second.output, Catch::Contains("interrupted after "));
    CHECK(run_apsl(run + "1").exit_code == 0);
}

TEST_CASE("output that cannot be written is an error, whatever the command") {
    const std::string curtain = scene_path("curtain_unfiltered.json");
    for (const std::string& arguments : {"run " + curtain + " --frames 1", "validate " + curtain,
                                         std::string("devices"), std::string("--help"), std::string("--version")}) {
        CAPTURE(arguments);
        // In a shell of its own, within which the redirection of run_apsl() does not reach.
        const ProgramRun run = run_apsl(arguments + " >/dev/full)", "(");
        CHECK(run.exit_code == 2);
        CHECK_THAT(run.errors, Catch::EndsWith("error: standard output: writing failed, is the disk full?\n"));
    }
}

TEST_CASE("a simulation that breaks down exits with 1 and a report that says where") {
    const TemporaryFolder folder;
    const std::string report_file = (folder.path() / "report.json").string();
    // Gravity beyond what a double holds after a few steps.
    const ProgramRun run =
        run_apsl("run " + scene_path("curtain_unfiltered.json") +
                 " --set gravity=[0,-1e308,0] --set time_step=100 --set integrator.none={} --report " + report_file);
    CHECK(run.exit_code == 1);
    CHECK_THAT(run.errors, Catch::Contains("broke down in frame"));
    CHECK_THAT(run.errors, Catch::EndsWith("softer springs or a larger regularization\n"));
    const nlohmann::json report = read_json(report_file);
    CHECK(report["summary"]["status"] == "diverged");
    CHECK(report["breakdown"]["frame"] == report["frames"].size() - 1);
    CHECK(report["frames"].back()["status"] == "diverged");
    CHECK(contains(keys(report["breakdown"]), {"frame", "step", "stage", "what"}));
}

TEST_CASE("a stand-alone cloth that breaks down is not advised on springs, for it has none") {
    const ProgramRun run =
        run_apsl("run " + scene_path("stand_alone_curtain.json") + " --frames 1 --set gravity=[0,-1e30,0]");
    CHECK(run.exit_code == 1);
    CHECK_THAT(run.errors, Catch::Contains("broke down in frame 0, step 0, stage stand_alone"));
    CHECK_THAT(run.errors, Catch::EndsWith("more sub_steps or a larger regularization\n"));
}

TEST_CASE("solves that do not converge are a status and a piece of advice") {
    const TemporaryFolder folder;
    const std::string report_file = (folder.path() / "report.json").string();
    const ProgramRun run = run_apsl("run " + scene_path("curtain.json") +
                                    " --frames 3 --set strain_limiting.max_iterations=1"
                                    " --set strain_limiting.tolerance=1e-5 --report " +
                                    report_file);
    CHECK(run.exit_code == 0);
    CHECK_THAT(run.errors, Catch::Contains("warning: strain limiting did not converge in 3 of 3 frames; raise"));
    CHECK(read_json(report_file)["summary"]["status"] == "not_converged");
    CHECK_THAT(read_json(report_file)["warnings"].at(0).get<std::string>(),
               Catch::StartsWith("strain limiting did not converge in 3 of 3 frames"));
}

TEST_CASE("the printed matrix below 2 is warned of, the consistent one is not") {
    const std::string command = "run " + scene_path("curtain.json") + " --frames 1";
    CHECK_THAT(run_apsl(command + " --set strain_limiting.matrix=printed").errors,
               Catch::Contains("warning: ") && Catch::Contains("printed matrix diverge"));
    const std::string listed = "run " + scene_path("curtain.json") +
                               " --frames 1 --set mesh.grid.vertices=[2,2] --set pins=[]"
                               " --set strain_limiting.matrix=printed --set strain_limiting.regularization=";
    CHECK_THAT(run_apsl(listed + "[2,1.2]").errors, Catch::Contains("printed matrix diverge"));
    CHECK_THAT(run_apsl(listed + "[2,2]").errors, !Catch::Contains("printed matrix diverge"));
    CHECK_THAT(run_apsl(command).errors, !Catch::Contains("warning"));
}

TEST_CASE("a stand-alone cloth: stages and parts of the time, and a warning where no ceiling holds it together") {
    const TemporaryFolder folder;
    const std::string out = (folder.path() / "out").string();
    const std::string command = "run " + scene_path("stand_alone_curtain.json") +
                                " --set mesh.grid.vertices=[9,9] --set 'pins=[{\"vertices\":[0,8]}]' --frames 3 "
                                "--set 'colliders=[{\"sphere\":{\"center\":[0,-1,0]}}]' --profile --out " +
                                out;
    const ProgramRun run = run_apsl(command);
    CAPTURE(run.errors);
    REQUIRE(run.exit_code == 0);
    CHECK_THAT(run.errors, !Catch::Contains("warning"));
    CHECK_THAT(run.output, Catch::Contains("ms in all; whole step ") && Catch::Contains(", collisions ") &&
                               !Catch::Contains("integration") && Catch::Contains("reading back ") &&
                               Catch::Contains(", measuring ") && Catch::Contains(", writing "));
    const nlohmann::json report = read_json(folder.path() / "out" / "report.json");
    CHECK(report["stages"] == nlohmann::json::array({"stand_alone", "colliders"}));
    for (const nlohmann::json& frame : report["frames"]) {
        CHECK(frame["integrator_seconds"] == 0.0);
        for (const char* part :
             {"filter_seconds", "collision_seconds", "read_back_seconds", "measuring_seconds", "writing_seconds"})
            CHECK(frame[part] > 0.0);
    }
    const auto& kernels = report["kernels"];
    CHECK(std::any_of(kernels.begin(), kernels.end(), [](const nlohmann::json& kernel) {
        return kernel["name"] == "fill_contacts" && kernel["launches"] == 3 && kernel["seconds"] > 0.0;
    }));
    std::string none = "[0";
    for (int triangle = 1; triangle < 128; ++triangle) none += ",0";
    for (const std::string& ceiling : {std::string("0"), none + "]"})
        CHECK_THAT(run_apsl(command + " --set strain_limiting.stretch_ceiling=" + ceiling).errors,
                   Catch::Contains("warning: ") && Catch::Contains("areas alone do not hold a cloth together"));
}

TEST_CASE("triangles that pins alone change are warned of") {
    const auto errors = [](const std::string& velocity) {
        return run_apsl("run " + scene_path("stand_alone_curtain.json") +
                        " --frames 6 --set 'mesh.grid={\"vertices\":[5,5]}' --set 'pins=[{\"vertices\":[0,1,6]},"
                        "{\"vertices\":[5],\"motion\":{\"translate\":{\"velocity\":" +
                        velocity + "}}}]'")
            .errors;
    };
    const std::string warning = "warning: triangles whose three corners are pinned change their areas by up to ";
    CHECK_THAT(errors("[0.5,-1,0.5]"), Catch::Contains(warning));
    CHECK_THAT(errors("[0,0,0]"), !Catch::Contains(warning));
}

TEST_CASE("bending springs that had to be added are warned of") {
    const std::string command = "validate " + scene_path("stand_alone_curtain.json") +
                                " --set integrator.bending_springs={} --set mesh.grid.diagonals=";
    CHECK_THAT(run_apsl(command + "alternating").errors,
               Catch::StartsWith("warning: ") && Catch::Contains("lattices that only areas join"));
    CHECK(run_apsl(command + "random").errors.empty());
}

TEST_CASE("a scene whose name is no UTF-8 leaves its report all the same") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("sc\xe9ne.json", R"({"mesh": {"grid": {"vertices": [5, 5]}}, "frames": 1})");
    const std::string report_file = (folder.path() / "report.json").string();
    const ProgramRun run = run_apsl("run " + scene + " --report " + report_file);
    CHECK(run.exit_code == 0);
    CHECK_THAT(run.output, Catch::Contains("status                 ok"));
    CHECK_THAT(read_json(report_file)["scene"].get<std::string>(), Catch::EndsWith("/sc\xef\xbf\xbdne.json"));
}

TEST_CASE("a cloth that is pushed together and cannot leave its plane is warned of, one with a little noise is not") {
    const TemporaryFolder folder;
    const auto run = [&](const std::string& start) {
        const std::string scene =
            folder.write("flat.json", R"({"mesh": {"grid": {"vertices": [17, 17], "plane": "vertical"}}, "frames": 60,
                "integrator": {"implicit_springs": {}}, "strain_limiting": {},
                "colliders": [{"sphere": {"center": [0, -0.9, 0], "radius": 0.3, "friction": 0.5}}])" +
                                          start + "}");
        return run_apsl("run " + scene);
    };
    CHECK_THAT(run("").errors, Catch::Contains("warning: the cloth was pushed together and never left the plane in "
                                               "which its z is the same"));
    CHECK_THAT(run(R"(, "start": {"random": 1e-4})").errors, !Catch::Contains("warning"));
}

TEST_CASE("a mesh in pieces that lie side by side is warned of on the screen and in the report, until it is welded") {
    const TemporaryFolder folder;
    folder.write("soup.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n");
    const std::string scene =
        folder.write("soup.json", R"({"mesh": {"file": "soup.obj"}, "frames": 1, "pins": [{"vertices": [0]}]})");
    const std::string report_file = (folder.path() / "report.json").string();
    const std::string warning = "in the place of another: 2; the cloth is in 2 pieces, 1 of them without a pin";
    const ProgramRun validated = run_apsl("validate " + scene);
    CHECK_THAT(validated.output, Catch::Contains("pieces     2, 1 of them without a pin"));
    CHECK_THAT(validated.errors, Catch::StartsWith("warning: ") && Catch::Contains(warning));
    const ProgramRun run = run_apsl("run " + scene + " --report " + report_file);
    CHECK(run.exit_code == 0);
    CHECK_THAT(run.output, Catch::Contains("pieces                 2, 1 of them without a pin"));
    CHECK_THAT(run.errors, Catch::Contains("warning: ") && Catch::Contains(warning));
    nlohmann::json report = read_json(report_file);
    CHECK(report["pieces"] == nlohmann::json{{"count", 2}, {"without_pin", 1}});
    REQUIRE(report["warnings"].size() == 1);
    CHECK_THAT(report["warnings"][0].get<std::string>(), Catch::Contains(warning));

    const ProgramRun welded = run_apsl("run " + scene + " --set mesh.weld=1e-5 --report " + report_file);
    CHECK_THAT(welded.output, !Catch::Contains("pieces"));
    CHECK_THAT(welded.errors, !Catch::Contains("warning"));
    report = read_json(report_file);
    CHECK(report["pieces"] == nlohmann::json{{"count", 1}, {"without_pin", 0}});
    CHECK(report["warnings"].empty());
    CHECK(report["vertices"] == 4);
}

TEST_CASE("several steps a frame are the same motion as so many frames") {
    const TemporaryFolder folder;
    const std::string scene = scene_path("twist.json") + " --backend reference --set mesh.grid.vertices=[9,9]";
    REQUIRE(run_apsl("run " + scene + " --frames 6 --out " + (folder.path() / "steps").string()).exit_code == 0);
    REQUIRE(
        run_apsl("run " + scene + " --frames 2 --set steps_per_frame=3 --out " + (folder.path() / "frames").string())
            .exit_code == 0);
    CHECK(read_bytes(folder.path() / "steps" / "frame_0005.vtp") ==
          read_bytes(folder.path() / "frames" / "frame_0001.vtp"));
    const nlohmann::json frames = read_json(folder.path() / "frames" / "report.json")["frames"];
    const nlohmann::json steps = read_json(folder.path() / "steps" / "report.json")["frames"];
    int iterations = 0;
    double greatest = 0.0;
    for (int k = 3; k < 6; ++k) {
        iterations += steps[k]["iterations"].get<int>();
        greatest = std::max(greatest, steps[k]["max_area_change"].get<double>());
    }
    CHECK(frames[1]["iterations"] == iterations);
    CHECK(frames[1]["max_area_change"] == greatest);
}
