// SPDX-License-Identifier: MIT
#include "run/scene_cloth.hpp"

#include "run/input_error.hpp"
#include "run/read_mesh.hpp"
#include "run/select_vertices.hpp"
#include "run/start_positions.hpp"
#include "run/words.hpp"

#include <apsl/error.hpp>
#include <apsl/reference.hpp>

#include <cmath>
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
    return read_mesh(source);
}

// A triangle this much smaller than the mean is nearly always a flaw of the mesh, and its area change is mostly noise.
constexpr double small_rest_area = 1e-6;

void check_rest_areas(const std::vector<double>& rest_areas, const std::string& name,
                      std::vector<std::string>& warnings) {
    const double mean = std::reduce(rest_areas.begin(), rest_areas.end()) / static_cast<double>(rest_areas.size());
    std::size_t small = 0;
    for (std::size_t a = 0; a < rest_areas.size(); ++a) {
        if (!(rest_areas[a] > 0.0))
            throw InputError(name + ": triangle " + std::to_string(a) + " has rest area 0, expected an area > 0");
        if (rest_areas[a] < small_rest_area * mean) ++small;
    }
    if (small > 0) {
        warnings.push_back(name + ": triangles with less than a millionth of the mean rest area: " +
                           std::to_string(small) + "; collapse them in the mesh");
    }
}

void note_topology(const Topology& topology, const std::string& name, std::vector<std::string>& warnings) {
    if (topology.isolated_vertex_count() > 0) {
        warnings.push_back(name + ": vertices in no triangle: " + std::to_string(topology.isolated_vertex_count()) +
                           "; they stay where they are, delete them from the mesh");
    }
    if (topology.non_manifold_edge_count() > 0) {
        warnings.push_back(
            name + ": edges with more than two triangles: " + std::to_string(topology.non_manifold_edge_count()) +
            "; areas are kept there too, but layers that should move apart need the mesh split there");
    }
}

void note_start_inside(const Scene& scene, const ClothState& cloth, std::vector<std::string>& warnings) {
    for (std::size_t k = 0; k < scene.colliders.size(); ++k) {
        const StartInside inside = start_inside(cloth, scene.colliders[k].shape);
        if (inside.vertices == 0) continue;
        warnings.push_back(scene.file + ": colliders[" + std::to_string(k) +
                           "]: vertices that start inside: " + std::to_string(inside.vertices) + ", by up to " +
                           short_number(inside.depth) + " m; they are led out slowly, move the cloth or the collider");
    }
}

// A pinned vertex keeps its inverse mass of 0.
void change_masses(const Scene& scene, const Mesh& mesh, ClothState& cloth) {
    for (std::size_t k = 0; k < scene.masses.size(); ++k) {
        const std::string where = scene.file + ": masses[" + std::to_string(k) + "]";
        for (const std::uint32_t vertex : select_vertices(scene.masses[k].selection, mesh, where)) {
            cloth.masses[vertex] *= scene.masses[k].factor;
            if (cloth.inverse_masses[vertex] == 0.0) continue;
            cloth.inverse_masses[vertex] /= scene.masses[k].factor;
            if (!std::isnormal(cloth.masses[vertex]) || !std::isnormal(cloth.inverse_masses[vertex]))
                throw InputError(where + ".factor: leaves vertex " + std::to_string(vertex) +
                                 " without a mass that can be counted with, expected a factor nearer to 1");
        }
    }
}

void check_triangle_values(const Scene& scene, const Topology& topology) {
    if (!scene.strain_limiting) return;
    const auto check_count = [&](const std::vector<float>& values, const char* key) {
        if (!values.empty() && values.size() != topology.triangle_count())
            throw InputError(scene.file + ": strain_limiting." + key + ": expected one number or one for each of " +
                             std::to_string(topology.triangle_count()) + " triangles, got " +
                             std::to_string(values.size()));
    };
    check_count(scene.strain_limiting->regularization, "regularization");
    check_count(scene.strain_limiting->stretch_ceilings, "stretch_ceiling");
}

}  // namespace

SceneCloth make_scene_cloth(const Scene& scene) {
    const MeshFile* file = std::get_if<MeshFile>(&scene.mesh);
    const std::string name = file != nullptr ? file->file.string() : scene.file + ": mesh";
    SceneCloth cloth;
    try {
        const Mesh mesh = std::visit([](const auto& source) { return mesh_of(source); }, scene.mesh);
        cloth.warnings = mesh.warnings;
        const auto topology = Topology::build(mesh.triangles, mesh.vertex_count());
        check_rest_areas(reference::areas<double>(*topology, mesh.positions), name, cloth.warnings);
        cloth.pins = resolve_pins(scene, mesh);
        cloth.state = make_cloth_state(topology, mesh.positions, scene.density, pinned_vertices(cloth.pins));
        change_masses(scene, mesh, cloth.state);
        set_start_positions(scene.start, cloth.state);
        for (double& area : cloth.state.rest_areas) area *= scene.start.rest_areas;
        note_topology(*topology, name, cloth.warnings);
        cloth.pieces = pieces_of(cloth.state);
        if (file != nullptr) {
            if (const auto warning = coincidence_warning(cloth.state, cloth.pieces))
                cloth.warnings.push_back(name + ": " + *warning);
        }
        cloth.light = light_vertices(cloth.state);
        if (const auto warning = light_vertices_warning(cloth.light)) cloth.warnings.push_back(name + ": " + *warning);
        cloth.caps = cap_triangles(cloth.state);
        if (const auto warning = cap_triangles_warning(cloth.caps)) cloth.warnings.push_back(name + ": " + *warning);
        cloth.needles = needle_triangles(cloth.state);
        if (const auto warning = needle_triangles_warning(cloth.needles, file != nullptr))
            cloth.warnings.push_back(name + ": " + *warning);
        note_start_inside(scene, cloth.state, cloth.warnings);
        check_triangle_values(scene, *topology);
    } catch (const Error& error) {
        throw InputError(name + ": " + error.what());
    }
    return cloth;
}

}  // namespace apsl::scenes
