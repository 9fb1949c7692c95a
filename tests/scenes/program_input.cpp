// SPDX-License-Identifier: MIT
// Wrong input of every kind: exit code 2, and one line that says what and where.
#include "run/folder_lock.hpp"
#include "scenes/program_run.hpp"
#include "scenes/sample_files.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <set>

using namespace apsl::test;

namespace {

void check_refused(const std::string& arguments, const std::string& message, const std::string& environment = "") {
    CAPTURE(arguments);
    const ProgramRun run = run_apsl(arguments, environment);
    CHECK(run.exit_code == 2);
    CHECK(run.output.empty());
    CHECK(std::count(run.errors.begin(), run.errors.end(), '\n') == 1);
    CHECK_THAT(run.errors, Catch::StartsWith("error: "));
    CHECK_THAT(run.errors, Catch::Contains(message));
}

const std::string grid_scene = R"({"mesh": {"grid": {"vertices": [5, 5]}}, "frames": 1, )";
const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("wrong usage is refused in one line") {
    check_refused("", "no command, expected run, devices, validate or tune");
    check_refused("fly", "fly");
    check_refused("run", "SCENE is required");
    check_refused("run " + scene_path("curtain.json") + " --backend cuda",
                  "--backend: is cuda, expected opencl or reference");
    check_refused("run " + scene_path("curtain.json") + " --frames 0", "--frames");
    check_refused("run " + scene_path("curtain.json") + " --frames many", "--frames");
    check_refused("run " + scene_path("curtain.json") + " --colour", "--colour");
    check_refused("run " + scene_path("curtain.json") + " --set frames", "--set frames: expected path=value");
    check_refused("run " + scene_path("curtain.json") + " --set strain_limiting.alpha=1.1",
                  "strain_limiting.alpha: unknown key");
    check_refused("validate " + scene_path("curtain.json") + " --set gravity[1]=-1",
                  "--set gravity[1]=-1: there is no \"gravity\" in the scene, expected all of it");
    check_refused("validate " + scene_path("curtain.json") + " --set pins[0]=null",
                  "pins[0]: expected an object, got null");
}

TEST_CASE("a key to take out that is not there is warned of") {
    const ProgramRun run = run_apsl("validate " + scene_path("curtain_unfiltered.json") + " --set strain_limitng=null");
    CHECK(run.exit_code == 0);
    CHECK(run.errors == "warning: --set strain_limitng=null: there is no such key in the scene to take out\n");
    CHECK(run_apsl("validate " + scene_path("curtain.json") + " --set strain_limiting=null").errors.empty());
}

TEST_CASE("wrong scenes are refused in one line, by run and by validate") {
    const TemporaryFolder folder;
    const std::string command = GENERATE("run ", "validate ");
    check_refused(command + (folder.path() / "missing.json").string(), "missing.json: no such scene file");
    check_refused(command + folder.write("broken.json", "{\n\"mesh\": \n}"),
                  "broken.json: not valid JSON: parse error at line 3");
    check_refused(command + folder.write("key.json", grid_scene + R"("wind": 1})"), "key.json: wind: unknown key");
    check_refused(command + folder.write("density.json", grid_scene + R"("density": -0.2})"),
                  "density.json: density: expected a number > 0, got -0.2");
    check_refused(command + folder.write("alpha.json", grid_scene + R"("strain_limiting": {"regularization": 0.9}})"),
                  "alpha.json: strain_limiting.regularization: expected a number ≥ 1, got 0.9");
    check_refused(command + folder.write("pin.json", grid_scene + R"("pins": [{"vertices": [25]}]})"),
                  "pin.json: pins[0].vertices[0]: vertex 25 is out of range");
}

TEST_CASE("wrong meshes are refused in one line") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("mesh.json", R"({"mesh": {"file": "mesh.obj"}, "frames": 1})");
    check_refused("run " + scene, "mesh.obj: no such mesh file");
    folder.write("mesh.obj", "");
    check_refused("run " + scene, "mesh.obj: has no vertices");
    folder.write("mesh.obj", corners + "v nan 0 0\nf 1 2 3\n");
    check_refused("run " + scene, "mesh.obj:4: expected three finite coordinates");
    folder.write("mesh.obj", corners + "f 1 2 9\n");
    check_refused("run " + scene, "mesh.obj:4: vertex 9 is out of range");
    folder.write("mesh.obj", corners + "v 2 0 0\nf 1 2 4\n");
    check_refused("run " + scene, "mesh.obj:5: a face without an area");
    const std::string ply = folder.write("nan.ply", ply_text(3, 1, "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"));
    check_refused("run " + scene + " --set mesh.file=" + ply,
                  "nan.ply:11: vertex 1: expected three finite coordinates");
}

TEST_CASE("lists of values that do not fit the mesh are refused in one line") {
    const TemporaryFolder folder;
    const std::string scene =
        folder.write("map.json", grid_scene + R"("strain_limiting": {"regularization": [1.1, 1.2]}})");
    check_refused("run " + scene + " --backend reference",
                  "strain_limiting.regularization: expected one number or one for each of 32 triangles, got 2");
    for (const char* command : {"run ", "validate "})
        check_refused(command + scene + " --set strain_limiting.regularization=1.1" +
                          " --set strain_limiting.stretch_ceiling=[1.1,1.2]",
                      "strain_limiting.stretch_ceiling: expected one number or one for each of 32 triangles, got 2");
}

TEST_CASE("a list without a stretch ceiling takes no more than a stretch ceiling of 0") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("bends.json", R"({"mesh": {"grid": {"vertices": [2, 2]}}, "frames": 1,
            "integrator": {"stand_alone": {"bending": 1e-4}}, "strain_limiting": {}})");
    const std::string refused = "integrator: stand_alone: bends is on, which needs limits_stretch";
    for (const char* ceiling : {"0", "[0,0]"})
        check_refused("run " + scene + " --set strain_limiting.stretch_ceiling=" + ceiling, refused);
    check_refused("run " + scene + " --set strain_limiting.stretch_ceiling=[0,0,0] --set integrator.stand_alone={}",
                  "strain_limiting.stretch_ceiling: expected one number or one for each of 2 triangles, got 3");
}

TEST_CASE("a device that is not there is refused in one line") {
    const std::string curtain = "run --frames 1 " + scene_path("curtain.json");
    check_refused(curtain + " --device 99", "--device 99: no such device, expected 0 to");
    check_refused(curtain + " --device -1", "--device -1: no such device");
}

TEST_CASE("no OpenCL platform at all is refused in one line that says what to install") {
    const TemporaryFolder no_drivers;
    const std::string environment = "OCL_ICD_VENDORS=" + no_drivers.path().string();
    check_refused("run --frames 1 " + scene_path("curtain.json"), "install pocl-opencl-icd", environment);
    check_refused("devices", "install pocl-opencl-icd", environment);
}

TEST_CASE("places that cannot be written to are refused in one line, before anything is simulated") {
    const TemporaryFolder folder;
    const std::string file = folder.write("file", "");
    const std::string curtain = "run --frames 1 " + scene_path("curtain.json");
    check_refused(curtain + " --out " + file + "/out", "file/out: cannot be made a folder");
    check_refused(curtain + " --out " + file, "file: cannot be made a folder");
    check_refused(curtain + " --report " + file + "/report.json", "report.json: no such folder");
    check_refused(curtain + " --report " + folder.path().string(), "exists and is no plain file");
    check_refused(curtain + " --report /dev/null", "/dev/null: exists and is no plain file");
    check_refused(curtain + " --report " + (folder.path() / "none/report.json").string(), "no such folder");
    const std::string name(300, 'a');
    check_refused(curtain + " --out " + name, name + ": cannot be made a folder: File name too long");
    check_refused(curtain + " --report " + name, name + ": cannot be written: File name too long");
    CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
    // Frames enough to run out the test's time.
    const std::string forever = scene_path("curtain.json") + " --frames 1000000";
    check_refused("run " + forever + " --report ''", "error: \"\": expected the name of a file");
    check_refused("run " + forever + " --report " + folder.path().string() + "/", "/\": expected the name of a file");
    check_refused("run " + forever + " --out ''", "error: \"\": expected the name of a folder");
    check_refused("tune --target 0.02 " + forever + " --out ''", "error: \"\": expected the name of a file");
}

TEST_CASE("files that cannot be read are refused in one line that says which, and why") {
    const TemporaryFolder folder;
    // A plain file, of which nothing can be read from its beginning on.
    check_refused("run /proc/self/mem", "/proc/self/mem: reading failed: Input/output error");
    check_refused("run " + folder.write("scene.json", R"({"mesh": {"file": "/proc/self/mem"}})"),
                  "/proc/self/mem: reading failed: Input/output error");
    check_refused("run " + folder.path().string(), folder.path().string() + ": is a folder or a device");
    check_refused("run " + (folder.path() / "scene.json/scene.json").string(),
                  "scene.json/scene.json: no such scene file");
    const std::string name(300, 'a');
    check_refused("run " + name, name + ": cannot be read: File name too long");
}

TEST_CASE("a run into a folder that another run writes into is refused in one line") {
    const TemporaryFolder folder;
    const apsl::scenes::FolderLock of_another_run(folder.path());
    check_refused("run --frames 1 " + scene_path("curtain_unfiltered.json") + " --out " + folder.path().string(),
                  folder.path().string() + ": another run writes there, expected a folder of its own for each");
    CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("what a folder holds stays but for what a run leaves there") {
    const TemporaryFolder folder;
    const std::set<std::string> kept{".apsl_probe", ".apsl_probe.partial", "frame_0000.txt", "report.json.bak"};
    for (const std::string& name : kept) folder.write(name, name);
    const std::string out = folder.path().string();
    CHECK(run_apsl("run --frames 1 " + scene_path("curtain_unfiltered.json") + " --out " + out).exit_code == 0);
    for (const std::string& name : kept) CHECK(read_bytes(folder.path() / name) == name);
}

TEST_CASE("an input is never overwritten, whatever names lead to it: refused in one line that names both") {
    const TemporaryFolder folder;
    const auto in_folder = [&](const char* name) { return (folder.path() / name).string(); };
    const std::string mesh_text = "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n";
    const std::string scene_text = R"({"mesh": {"file": "cloth.obj"}, "frames": 1, "strain_limiting": {}})";
    const std::string mesh = folder.write("cloth.obj", mesh_text);
    const std::string scene = folder.write("scene.json", scene_text);
    std::filesystem::create_symlink(scene, folder.path() / "link.json");
    std::filesystem::create_hard_link(mesh, folder.path() / "hard.obj");
    std::filesystem::create_hard_link(scene, folder.path() / "later.json.partial");
    const auto check_kept = [&](const std::string& arguments, const std::string& message) {
        check_refused(arguments, message);
        CHECK(read_bytes(mesh) == mesh_text);
        CHECK(read_bytes(scene) == scene_text);
        CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 5);
    };
    for (const std::string& command : {"run " + scene + " --report ", "tune " + scene + " --target 0.1 --out "}) {
        check_kept(command + scene, scene + ": would overwrite the scene, " + scene);
        check_kept(command + in_folder("link.json"), "link.json: would overwrite the scene, " + scene);
        check_kept(command + in_folder("hard.obj"), "hard.obj: would overwrite the mesh, " + mesh);
        check_kept(command + in_folder("later.json"), "later.json.partial: would overwrite the scene, " + scene);
    }
    check_kept("run " + scene + " --out " + folder.path().string(), "cloth.obj: would overwrite the mesh, " + mesh);
    const TemporaryFolder elsewhere;
    for (const char* name : {"report.json", "frame_0000.vtp", "cloth.pvd.partial"}) {
        const TemporaryFolder other;
        const std::string named = other.write(name, R"({"mesh": {"grid": {"vertices": [2, 2]}}, "frames": 1})");
        check_refused("run " + named + " --out " + other.path().string(), "would overwrite the scene, " + named);
        CHECK(std::filesystem::file_size(named) > 0);
    }
    check_refused("run " + scene + " --out " + elsewhere.path().string() + " --report " +
                      (elsewhere.path() / "cloth.pc2").string(),
                  "cloth.pc2: the report would overwrite what the run leaves in");
}
