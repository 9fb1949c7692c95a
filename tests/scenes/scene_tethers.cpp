// SPDX-License-Identifier: MIT
#include "run/scene_tethers.hpp"

#include "run/filter_stage.hpp"
#include "run/parse_scene.hpp"
#include "run/scene_cloth.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

using namespace apsl;
using namespace apsl::scenes;

namespace {

// 5 × 5 vertices, 0.25 m apart.
Scene grid_with(const std::string& pins, const std::string& stand_alone, const std::string& more = "") {
    return parse_scene(nlohmann::json::parse(R"({"mesh": {"grid": {"vertices": [5, 5], "size": [1, 1]}}, "pins": )" +
                                             pins + R"(, "integrator": {"stand_alone": )" + stand_alone +
                                             R"(}, "strain_limiting": {"stretch_ceiling": 1.1})" + more + "}"),
                       "scene.json");
}

struct Tied {
    StrainLimiting limiting;
    Tethers tethers;
};

Tied tied(const Scene& scene) {
    const SceneCloth cloth = make_scene_cloth(scene);
    Tied made{limiting_of(scene, cloth.state), {}};
    if (made.limiting.options.tethers_per_vertex > 0) made.tethers = scene_tethers(cloth.state, made.limiting);
    return made;
}

}  // namespace

TEST_CASE("tethers of a scene: one to each pinned piece, as long as the way there at rest") {
    const Tied made = tied(grid_with(R"([{"vertices": [0, 4]}])", "{}"));
    REQUIRE(made.limiting.options.tethers_per_vertex == 2);
    // Vertex 20 is a corner below vertex 0.
    CHECK(made.tethers.anchors[2 * 20] == 0);
    CHECK(made.tethers.lengths[2 * 20] == Approx(1.0f));
    CHECK(made.tethers.anchors[2 * 20 + 1] == 4);
    CHECK(made.tethers.lengths[2 * 20 + 1] == Approx(std::sqrt(2.0f)));
    CHECK(made.tethers.lengths[0] == 0.0f);
}

TEST_CASE("tethers of a scene: the factor, and rest areas that are not the mesh's, make them longer") {
    CHECK(tied(grid_with(R"([{"vertices": [0]}])", R"({"tethers": 1.1})")).tethers.lengths[20] == Approx(1.1f));
    CHECK(tied(grid_with(R"([{"vertices": [0]}])", "{}", R"(, "start": {"rest_areas": 4})")).tethers.lengths[20] ==
          Approx(2.0f));
    // A start that is scaled is not how the cloth rests.
    CHECK(tied(grid_with(R"([{"vertices": [0]}])", "{}", R"(, "start": {"scale": [2, 2, 2]})")).tethers.lengths[20] ==
          Approx(1.0f));
}

TEST_CASE("tethers of a scene: none without pins, or where none are asked for, and four at most") {
    CHECK(tied(grid_with("[]", "{}")).limiting.options.tethers_per_vertex == 0);
    CHECK(tied(grid_with(R"([{"vertices": [0]}])", R"({"tethers": 0})")).limiting.options.tethers_per_vertex == 0);
    CHECK(tied(grid_with(R"([{"vertices": [0, 1, 2, 3, 4]}])", "{}")).limiting.options.tethers_per_vertex == 1);
    CHECK(tied(grid_with(R"([{"vertices": [0, 2, 4, 20, 24]}])", "{}")).limiting.options.tethers_per_vertex == 4);
}
