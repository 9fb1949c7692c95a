// SPDX-License-Identifier: MIT
#include "run/scene_cloth.hpp"

#include "run/parse_scene.hpp"
#include "scenes/sample_files.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

using namespace apsl;
using namespace apsl::scenes;
using apsl::test::input_error_of;
using apsl::test::TemporaryFolder;

namespace {

Scene parse(const std::string& text) {
    return parse_scene(nlohmann::json::parse(text), "scene.json");
}

SceneCloth pinned_grid(const std::string& pins) {
    return make_scene_cloth(parse(R"({"mesh": {"grid": {"vertices": [5, 3], "size": [4, 2]}}, "pins": )" + pins + "}"));
}

SceneCloth cloth_of_file(const std::string& file) {
    Scene scene;
    scene.mesh = MeshFile{.file = file, .height = {}};
    return make_scene_cloth(scene);
}

}  // namespace

TEST_CASE("a cloth weighs its area times the density") {
    const SceneCloth cloth = make_scene_cloth(parse(R"({"mesh": {"grid": {"size": [2, 3]}}, "density": 0.5})"));
    CHECK(std::reduce(cloth.state.masses.begin(), cloth.state.masses.end()) == Approx(3.0));
    CHECK(cloth.warnings.empty());
}

TEST_CASE("pins select vertices by number, corner and box") {
    CHECK(pinned_grid(R"([{"vertices": [3, 0]}])").pins[0].vertices == std::vector<std::uint32_t>{3, 0});
    CHECK(pinned_grid(R"([{"corners": ["min_x_min_z", "max_x_min_z", "min_x_max_z", "max_x_max_z"]}])")
              .pins[0]
              .vertices == std::vector<std::uint32_t>{0, 4, 10, 14});
    CHECK(pinned_grid(R"([{"corners": ["max_z_min_x", "max_x"]}])").pins[0].vertices ==
          std::vector<std::uint32_t>{10, 4});
    CHECK(pinned_grid(R"([{"box": {"max": [-1, 9, 0]}}])").pins[0].vertices == std::vector<std::uint32_t>{0, 1, 5, 6});
    const SceneCloth cloth = pinned_grid(R"([{"vertices": [1]}, {"box": {"min": [2, -1, -1]}}])");
    for (std::size_t v = 0; v < 15; ++v) CHECK((cloth.state.inverse_masses[v] == 0.0) == (v == 1 || v % 5 == 4));
}

TEST_CASE("pins that select nothing are named") {
    const auto [pins, message] = GENERATE(table<std::string, std::string>({
        {R"([{"vertices": [0]}, {"vertices": [1, 15]}])",
         "scene.json: pins[1].vertices[1]: vertex 15 is out of range, expected 0 to 14"},
        {R"([{"corners": ["min_w"]}])", "scene.json: pins[0].corners: \"min_w\" is no corner"},
        {R"([{"corners": ["min_x_max_x"]}])", "scene.json: pins[0].corners: \"min_x_max_x\" is no corner"},
        {R"([{"corners": ["min_x-max_z"]}])", "scene.json: pins[0].corners: \"min_x-max_z\" is no corner"},
        {R"([{"corners": [""]}])", "scene.json: pins[0].corners: \"\" is no corner"},
        {R"([{"box": {"min": [9, 9, 9]}}])", "scene.json: pins[0].box: no vertex of the mesh lies inside"},
    }));
    CHECK_THAT(input_error_of([given = pins] { pinned_grid(given); }), Catch::StartsWith(message));
}

TEST_CASE("masses are multiplied, pinned vertices stay pinned, the rest keeps its mass") {
    const std::string grid = R"({"mesh": {"grid": {"vertices": [5, 3], "size": [4, 2]}}, "pins": [{"vertices": [0]}])";
    const ClothState plain = make_scene_cloth(parse(grid + "}")).state;
    const ClothState heavy =
        make_scene_cloth(
            parse(grid +
                  R"(, "masses": [{"vertices": [0, 7], "factor": 1000}, {"box": {"max": [-1, 9, 9]}, "factor": 2}]})"))
            .state;
    for (std::size_t v = 0; v < 15; ++v) {
        const double factor = (v == 0 || v == 7 ? 1000.0 : 1.0) * (v % 5 < 2 ? 2.0 : 1.0);
        CHECK(heavy.masses[v] == Approx(factor * plain.masses[v]));
        CHECK(heavy.inverse_masses[v] == Approx(plain.inverse_masses[v] / factor));
    }
    CHECK(heavy.inverse_masses[0] == 0.0);
    CHECK(input_error_of([&] { make_scene_cloth(parse(grid + R"(, "masses": [{"vertices": [15]}]})")); }) ==
          "scene.json: masses[0].vertices[0]: vertex 15 is out of range, expected 0 to 14");
    for (const std::string factor : {"1e-300", "1e300"}) {
        const std::string masses =
            R"([{"vertices": [7], "factor": )" + factor + R"(}, {"box": {}, "factor": )" + factor + "}]";
        CHECK_THAT(input_error_of([&] { make_scene_cloth(parse(grid + ", \"masses\": " + masses + "}")); }),
                   Catch::StartsWith("scene.json: masses[1].factor: leaves vertex 7 without a mass"));
    }
}

TEST_CASE("a cloth starts scaled about its middle, or shaken, and its rest stays") {
    const auto start = [](const std::string& values) {
        return make_scene_cloth(parse(R"({"mesh": {"grid": {"vertices": [5, 3], "size": [4, 2]}},
                                          "pins": [{"vertices": [0]}], "start": )" +
                                      values + "}"))
            .state;
    };
    const ClothState mirrored = start(R"({"scale": [-1, 1, 0]})");
    for (std::size_t v = 1; v < 15; ++v) {
        CHECK(mirrored.positions[3 * v] == Approx(-mirrored.rest_positions[3 * v]).margin(1e-12));
        CHECK(mirrored.positions[3 * v + 2] == Approx(0.0).margin(1e-12));
    }
    CHECK(mirrored.positions[0] == mirrored.rest_positions[0]);
    CHECK(mirrored.rest_areas[0] == Approx(0.5));

    const ClothState shaken = start(R"({"random": 0.25})");
    double farthest = 0.0;
    for (std::size_t i = 0; i < 45; ++i)
        farthest = std::max(farthest, std::abs(shaken.positions[i] - shaken.rest_positions[i]));
    CHECK(farthest <= 0.25);
    CHECK(farthest > 0.2);
    CHECK(shaken.positions == start(R"({"random": 0.25})").positions);
    CHECK(start("{}").positions == start("{}").rest_positions);

    const ClothState larger = start(R"({"rest_areas": 1.5})");
    CHECK(larger.positions == larger.rest_positions);
    CHECK(larger.rest_areas[0] == Approx(0.75));
    CHECK(larger.masses == start("{}").masses);
}

TEST_CASE("flaws of a mesh are warned of, with what to do") {
    const TemporaryFolder folder;
    const std::string isolated = folder.write("isolated.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 1 2 3\n");
    REQUIRE(cloth_of_file(isolated).warnings.size() == 1);
    CHECK(cloth_of_file(isolated).warnings[0] ==
          isolated + ": vertices in no triangle: 1; they stay where they are, delete them from the mesh");
    const std::string fin =
        folder.write("fin.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 2 1 4\nf 1 2 5\n");
    REQUIRE(cloth_of_file(fin).warnings.size() == 1);
    CHECK_THAT(cloth_of_file(fin).warnings[0], Catch::StartsWith(fin + ": edges with more than two triangles: 1;"));
}

TEST_CASE("triangles that lie side by side and share no vertex are warned of, with a weld that joins them") {
    const TemporaryFolder folder;
    const std::string soup = folder.write(
        "soup.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 9 9 9\nv 9 9 9\nf 1 2 3\nf 4 5 6\n");
    Scene scene;
    scene.mesh = MeshFile{.file = soup, .height = {}};
    scene.pins = {Pin{SelectedVertices{{4}}, {}}};
    const SceneCloth apart = make_scene_cloth(scene);
    CHECK(apart.pieces.count == 2);
    CHECK(apart.pieces.without_pin == 1);
    REQUIRE(apart.warnings.size() == 2);  // the other is of the vertices in no triangle
    CHECK(apart.warnings[1] == soup +
                                   ": vertices in the place of another: 2; the cloth is in 2 pieces, 1 of them without "
                                   "a pin, and comes apart there; to join them, write \"weld\": 1e-05 (m) beside "
                                   "\"file\" in mesh");
    scene.mesh = MeshFile{.file = soup, .height = {}, .weld = 1e-5};
    const SceneCloth whole = make_scene_cloth(scene);
    CHECK(whole.pieces.count == 1);
    CHECK(whole.warnings.size() == 1);
    // The pin means vertex 4 of the file, which is the fourth that is left.
    CHECK(whole.pins[0].vertices == std::vector<std::uint32_t>{3});
    scene.pins = {Pin{SelectedVertices{{8}}, {}}};
    CHECK_THAT(input_error_of([&] { make_scene_cloth(scene); }), Catch::Contains("out of range, expected 0 to 7"));
}

TEST_CASE("pieces that are meant to be apart are counted, not warned of; an open seam within one piece is warned of") {
    const TemporaryFolder folder;
    const std::string layers = folder.write(
        "layers.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0.001\nv 1 0 0.001\nv 0 1 0.001\nf 1 2 3\nf 4 5 6\n");
    CHECK(cloth_of_file(layers).pieces.count == 2);
    CHECK(cloth_of_file(layers).pieces.without_pin == 2);
    CHECK(cloth_of_file(layers).warnings.empty());
    const std::string seam =
        folder.write("seam.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 1\nv 0 0 0\nf 1 2 3\nf 3 2 4\nf 3 4 5\n");
    CHECK(cloth_of_file(seam).pieces.count == 1);
    REQUIRE(cloth_of_file(seam).warnings.size() == 1);
    CHECK_THAT(cloth_of_file(seam).warnings[0],
               Catch::Contains("in the place of another: 1; the cloth is in 1 piece and"));
}

TEST_CASE("vertices nearer to each other than a millionth of the cloth are not in one place where edges are as short") {
    const TemporaryFolder folder;
    const std::string far = folder.write("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1e9 1e9 0\nf 1 2 3\nf 2 4 3\n");
    for (const std::string& warning : cloth_of_file(far).warnings)
        CHECK_THAT(warning, !Catch::Contains("in the place of another"));
}

TEST_CASE("a cloth that starts inside of a collider is warned of") {
    const std::string grid =
        R"({"mesh": {"grid": {"vertices": [5, 3], "size": [4, 2]}}, "pins": [{"vertices": [7]}], )";
    const auto cloth = [&](const std::string& collider) {
        return make_scene_cloth(parse(grid + "\"colliders\": [" + collider + "]}"));
    };
    CHECK(cloth(R"({"plane": {"point": [0, 0.5, 0]}})").warnings ==
          std::vector<std::string>{
              "scene.json: colliders[0]: vertices that start inside: 14, by up to 0.5 m; they are led "
              "out slowly, move the cloth or the collider"});
    CHECK_THAT(
        cloth(R"({"plane": {"point": [0, -1, 0]}}, {"sphere": {"center": [1, 0, 0], "radius": 0.25}})").warnings.at(0),
        Catch::StartsWith("scene.json: colliders[1]: vertices that start inside: 1, by up to 0.25 m"));
    CHECK(cloth(R"({"plane": {"point": [0, 0, 0]}})").warnings.empty());
    CHECK(cloth(R"({"sphere": {"center": [0, 0, 0], "radius": 0.25}})").warnings.empty());  // a pinned vertex alone
}

TEST_CASE("a triangle of rest area 0 is an error") {
    const TemporaryFolder folder;
    const std::string flat = folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\n");
    CHECK_THAT(input_error_of([&] { cloth_of_file(flat); }), Catch::StartsWith(flat + ":6: a face without an area"));
    CHECK(input_error_of([] { make_scene_cloth(parse(R"({"mesh": {"grid": {"size": [1e-200, 1e-200]}}})")); }) ==
          "scene.json: mesh: triangle 0 has rest area 0, expected an area > 0");
}
