// SPDX-License-Identifier: MIT
#include "pipeline/pins.hpp"
#include "run/commands.hpp"
#include "run/float_range.hpp"
#include "run/parse_scene.hpp"
#include "run/scene_cloth.hpp"
#include "run/simulation.hpp"

#include <cstdio>
#include <numeric>
#include <utility>

namespace apsl::scenes {

int validate_command(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    const Scene scene = read_scene(file, overrides);
    SceneCloth cloth = make_scene_cloth(scene);
    const Topology& topology = *cloth.state.topology;
    const double area = std::reduce(cloth.state.rest_areas.begin(), cloth.state.rest_areas.end());
    const double mass = std::reduce(cloth.state.masses.begin(), cloth.state.masses.end());

    std::printf("%s: a valid scene\n", scene.file.c_str());
    std::printf("  mesh       %zu vertices, %zu triangles, %zu boundary edges\n", topology.vertex_count(),
                topology.triangle_count(), topology.boundary_edge_count());
    std::printf("  pieces     %zu, %zu of them without a pin\n", cloth.pieces.count, cloth.pieces.without_pin);
    std::printf("  cloth      %.4g m² at rest, %.4g kg\n", area, mass);
    std::printf("  pins       %zu vertices in %zu groups\n", pinned_vertices(cloth.pins).size(), cloth.pins.size());
    std::printf("  time       %d frames of %d steps of %.4g s\n", scene.frames, scene.steps_per_frame, scene.time_step);
    std::vector<std::string> warnings = cloth.warnings;
    if (const auto text = beyond_float_range(cloth.state); text && scene.strain_limiting)
        warnings.push_back(scene.file + ": " + *text);
    // Without a filter stage: validating needs no device.
    const Simulation simulation(scene, std::move(cloth), std::monostate{}, false);
    std::printf("  stages    ");
    for (const std::string& stage : simulation.stages()) std::printf(" %s", stage.c_str());
    std::printf("\n");
    warnings.insert(warnings.end(), simulation.warnings().begin(), simulation.warnings().end());
    for (const std::string& line : warnings) std::fprintf(stderr, "warning: %s\n", line.c_str());
    return exit_done;
}

}  // namespace apsl::scenes
