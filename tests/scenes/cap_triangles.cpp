// SPDX-License-Identifier: MIT
#include "run/cap_triangles.hpp"

#include "run/scene_cloth.hpp"
#include "run/summary.hpp"
#include "scenes/sample_files.hpp"

#include <catch2/catch.hpp>

using namespace apsl::scenes;
using apsl::test::TemporaryFolder;

namespace {

// A square of four triangles around a vertex at a distance from the edge below.
SceneCloth square_around(const TemporaryFolder& folder, double distance) {
    Scene scene;
    scene.mesh = MeshFile{
        .file = folder.write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 " + std::to_string(distance) +
                                               " 0\nf 2 3 5\nf 1 2 5\nf 3 4 5\nf 4 1 5\n"),
        .height = {}};
    return make_scene_cloth(scene);
}

}  // namespace

TEST_CASE("a corner close to the opposite edge makes a cap, a short edge does not") {
    const TemporaryFolder folder;
    const SceneCloth cap = square_around(folder, 0.005);
    CHECK(cap.caps.count == 1);
    CHECK(cap.caps.flattest == 1);
    CHECK(cap.caps.height == Approx(0.005));
    REQUIRE(cap.warnings.size() == 1);
    CHECK_THAT(cap.warnings[0], Catch::EndsWith("triangles with a corner close to the opposite edge: 1 (flattest: "
                                                "triangle 1, height 1/200 of its longest edge); their areas are hard "
                                                "to hold, flip the longest edge of triangle 1 in the mesh"));
    const SceneCloth ordinary = square_around(folder, 0.025);
    CHECK(ordinary.caps.count == 0);
    CHECK(ordinary.warnings.empty());
    Scene needle;
    needle.mesh =
        MeshFile{.file = folder.write("needle.obj", "v 0 0 0\nv 1 0 0\nv 1 0.005 0\nf 1 2 3\n"), .height = {}};
    CHECK(make_scene_cloth(needle).caps.count == 0);
}

TEST_CASE("where masses are raised and none is small, a summary points to the caps") {
    const TemporaryFolder folder;
    const SceneCloth cloth = square_around(folder, 0.005);
    RunReport report;
    report.vertices = 5;
    report.backend = "none";
    report.light = cloth.light;
    report.caps = cloth.caps;
    FrameReport& frame = report.frames.emplace_back();
    frame.raised_vertices = 2;
    frame.greatest_mass_ratio = 3.0;
    CHECK(report.light.count == 0);
    CHECK_THAT(summary_text(report), Catch::Contains("up to 3 times: flip the longest edge of triangle 1 in the mesh"));
    report.light.count = 1;
    CHECK_THAT(summary_text(report), Catch::Contains("up to 3 times: give them more mass"));
}
