// SPDX-License-Identifier: MIT
#include "run/opencl_filter.hpp"

#include "run/filter_stage.hpp"
#include "run/fixed_sequence.hpp"
#include "run/parse_scene.hpp"
#include "run/scene_cloth.hpp"
#include "scenes/sample_files.hpp"

#include <catch2/catch.hpp>

using namespace apsl;
using namespace apsl::scenes;
using apsl::test::input_error_of;

namespace {

Scene parse(const std::string& mesh) {
    return parse_scene(nlohmann::json::parse(R"({"strain_limiting": {"sub_steps": 4}, "mesh": )" + mesh + "}"),
                       "scene.json");
}

// A cloth whose coordinates are multiples of 1/32 m, thrown about.
std::vector<double> filtered_velocities(double away) {
    const Scene scene = parse(R"({"grid": {"vertices": [33, 33]}})");
    ClothState cloth = make_scene_cloth(scene).state;
    FixedSequence noise;
    for (double& velocity : cloth.velocities) velocity = noise.symmetric();
    for (double& coordinate : cloth.positions) coordinate += away;
    OpenClFilter filter(choose_opencl_device({}), cloth, *scene.strain_limiting, false);
    filter.filter(cloth);
    // A second call from elsewhere: the origin goes with the cloth.
    for (double& coordinate : cloth.positions) coordinate -= 2.0 * away;
    filter.filter(cloth);
    return cloth.velocities;
}

}  // namespace

TEST_CASE("far from the origin the filter does bit for bit what it does there") {
    const std::vector<double> here = filtered_velocities(0.0);
    for (const double away : {1024.0, 131072.0, 134217728.0}) {
        CAPTURE(away);
        CHECK(filtered_velocities(away) == here);
    }
}

TEST_CASE("what 32 bits do not hold is refused before it goes to the device") {
    const auto [mesh, message] = GENERATE(table<std::string, std::string>({
        {R"({"grid": {"vertices": [2, 2], "size": [1e30, 1e30]}})",
         "the rest area (m²) of triangle 0 is 5e+59, beyond the 32 bits"},
        {R"({"grid": {"vertices": [2, 2], "size": [1e10, 1e10]}})",
         "the rest area (m²) of triangle 0 is 5e+19, beyond the 32 bits"},
        {R"({"grid": {"vertices": [2, 2], "size": [1e-30, 1e-30]}})", "the rest area (m²) of triangle 0 is 5e-61"},
        {R"({"grid": {"vertices": [2, 2], "size": [2e-19, 2e-19]}})", "the inverse mass (1/kg) of vertex 0 is"},
        {R"({"grid": {"vertices": [2, 2], "size": [1e60, 1e-60]}})", "a coordinate (m) of vertex 0 is -5e+59, beyond"},
    }));
    const Scene scene = parse(mesh);
    const ClothState cloth = make_scene_cloth(scene).state;
    const OpenClDevice device = choose_opencl_device({});
    CHECK_THAT(input_error_of([&] { make_filter_stage(scene, cloth, Backend::opencl, device, false); }),
               Catch::StartsWith("scene.json: " + message));
    CHECK(std::holds_alternative<ReferenceFilter>(make_filter_stage(scene, cloth, Backend::reference, {}, false)));
}
