// SPDX-License-Identifier: MIT
#include "run/scene_cloth.hpp"

#include "run/input_error.hpp"
#include "run/read_mesh.hpp"
#include "run/resolve_pins.hpp"

#include <apsl/error.hpp>

#include <numeric>

namespace apsl::scenes {
namespace {

Mesh mesh_of(const GridMesh& grid) {
    return make_mesh(grid);
}
Mesh mesh_of(const TubeMesh& tube) {
    return make_mesh(tube);
}
Mesh mesh_of(const MeshFile& source) {
    return read_mesh(source.file, source.height);
}

// A triangle this much smaller than the mean is nearly always a flaw of the mesh, and its area change is mostly noise.
constexpr double kSmallRestArea = 1e-6;

void check_rest_areas(const ClothState& cloth, const std::string& name, std::vector<std::string>& warnings) {
    const double mean =
        std::reduce(cloth.rest_areas.begin(), cloth.rest_areas.end()) / static_cast<double>(cloth.rest_areas.size());
    std::size_t small = 0;
    for (std::size_t a = 0; a < cloth.rest_areas.size(); ++a) {
        if (!(cloth.rest_areas[a] > 0.0)) {
            throw InputError(name + ": triangle " + std::to_string(a) + " has rest area 0, expected an area > 0");
        }
        if (cloth.rest_areas[a] < kSmallRestArea * mean) ++small;
    }
    if (small > 0) {
        warnings.push_back(name + ": " + std::to_string(small) +
                           " triangles have less than a millionth of the mean rest area; collapse them in the mesh");
    }
}

void note_topology(const Topology& topology, const std::string& name, std::vector<std::string>& warnings) {
    if (topology.isolated_vertex_count() > 0) {
        warnings.push_back(name + ": " + std::to_string(topology.isolated_vertex_count()) +
                           " vertices are in no triangle and stay where they are; delete them from the mesh");
    }
    if (topology.non_manifold_edge_count() > 0) {
        warnings.push_back(name + ": " + std::to_string(topology.non_manifold_edge_count()) +
                           " edges have more than two triangles; areas are kept there too, but if layers should move "
                           "apart split the mesh along those edges");
    }
}

}  // namespace

SceneCloth make_scene_cloth(const Scene& scene) {
    const MeshFile* file = std::get_if<MeshFile>(&scene.mesh);
    const std::string name = file != nullptr ? file->file.string() : scene.file + ": mesh";
    SceneCloth cloth;
    try {
        const Mesh mesh = std::visit([](const auto& source) { return mesh_of(source); }, scene.mesh);
        const auto topology = Topology::build(mesh.triangles, mesh.vertex_count());
        cloth.pins = resolve_pins(scene, mesh);
        cloth.state = make_cloth_state(topology, mesh.positions, scene.density, pinned_vertices(cloth.pins));
        check_rest_areas(cloth.state, name, cloth.warnings);
        note_topology(*topology, name, cloth.warnings);
    } catch (const Error& error) {
        throw InputError(name + ": " + error.what());
    }
    return cloth;
}

}  // namespace apsl::scenes
