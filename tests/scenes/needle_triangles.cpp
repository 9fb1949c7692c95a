// SPDX-License-Identifier: MIT
#include "run/needle_triangles.hpp"

#include "run/report.hpp"
#include "run/scene_cloth.hpp"
#include "scenes/sample_files.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

using namespace apsl::scenes;
using apsl::test::TemporaryFolder;

namespace {

// A square of 1 m around an edge that lies in its middle, along x, with a triangle on either side of it.
SceneCloth square_around(const TemporaryFolder& folder, double edge, double weld = 0.0) {
    Scene scene;
    scene.mesh =
        MeshFile{.file = folder.write(
                     "square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 0\nv " + std::to_string(0.5 + edge) +
                                       " 0.5 0\nf 1 2 5\nf 2 6 5\nf 2 3 6\nf 3 5 6\nf 3 4 5\nf 4 1 5\n"),
                 .height = {},
                 .weld = weld};
    return make_scene_cloth(scene);
}

}  // namespace

TEST_CASE("one edge far shorter than the others makes needles, until its ends are joined") {
    const TemporaryFolder folder;
    // The needles' longest edges are from the middle to a corner: the root of 1/2.
    const double longest = std::sqrt(0.5);
    const SceneCloth sharp = square_around(folder, 0.005);
    CHECK(sharp.needles.count == 2);
    CHECK((sharp.needles.sharpest == 1 || sharp.needles.sharpest == 3));
    CHECK(sharp.needles.shortest_over_longest == Approx(0.005 / longest));
    CHECK(sharp.caps.count == 0);
    REQUIRE(sharp.needles.weld_distance);
    CHECK(*sharp.needles.weld_distance == Approx(0.0055));
    REQUIRE(sharp.warnings.size() == 1);
    CHECK_THAT(sharp.warnings[0],
               Catch::Contains("triangles with one edge much shorter than the others: 2 (sharpest: triangle ") &&
                   Catch::EndsWith(", shortest edge 1/141 of its longest); they stretch across it whatever the "
                                   "limiter does, join those vertices: write \"weld\": 5.5e-03 (m) beside \"file\" in "
                                   "mesh"));
    CHECK(square_around(folder, 0.005, 5.5e-3).needles.count == 0);

    const SceneCloth ordinary = square_around(folder, 0.0075);
    CHECK(ordinary.needles.count == 0);
    CHECK(ordinary.needles.shortest_over_longest == Approx(0.0075 / longest));
    CHECK(ordinary.warnings.empty());

    RunReport report;
    report.needles = sharp.needles;
    CHECK(to_json(report)["needle_triangles"] ==
          nlohmann::json{{"count", 2},
                         {"sharpest", sharp.needles.sharpest},
                         {"shortest_over_longest_edge", sharp.needles.shortest_over_longest}});
}

TEST_CASE("where joining would take more than needles, or nothing can be joined, edges are to be collapsed") {
    NeedleTriangles needles{.count = 1, .sharpest = 7, .shortest_over_longest = 1e-3, .weld_distance = {}};
    CHECK_THAT(*needle_triangles_warning(needles, true), Catch::EndsWith("collapse their shortest edges in the mesh"));
    needles.weld_distance = 1e-4;
    CHECK_THAT(*needle_triangles_warning(needles, false), Catch::EndsWith("collapse their shortest edges in the mesh"));
    CHECK_FALSE(needle_triangles_warning({}, true));

    const TemporaryFolder folder;
    Scene scene;
    scene.mesh = MeshFile{.file = folder.write("needle.obj", "v 0 0 0\nv 1 0 0\nv 1 0.005 0\nf 1 2 3\n"), .height = {}};
    const SceneCloth all = make_scene_cloth(scene);  // joined, it would be gone
    CHECK(all.needles.count == 1);
    CHECK_FALSE(all.needles.weld_distance);
}
