// SPDX-License-Identifier: MIT
#include "unit/sample_meshes.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

namespace apsl::test {
namespace {

Mesh with_isolated_vertices(Mesh mesh) {
    // In front, so that every index moves, in the middle of nowhere, and behind.
    Mesh result{{}, {9, 9, 9}};
    result.positions.insert(result.positions.end(), mesh.positions.begin(), mesh.positions.end());
    result.positions.insert(result.positions.end(), {8, 8, 8, 7, 7, 7});
    for (const Triangle& t : mesh.triangles) result.triangles.push_back({t[0] + 1, t[1] + 1, t[2] + 1});
    return result;
}

Mesh with_duplicates(Mesh mesh) {
    const Triangle first = mesh.triangles.front();
    mesh.triangles.push_back(first);                           // the same
    mesh.triangles.push_back({first[1], first[2], first[0]});  // begun elsewhere
    mesh.triangles.push_back({first[2], first[1], first[0]});  // wound the other way
    return mesh;
}

}  // namespace

std::vector<SampleMesh> small_meshes() {
    std::vector<SampleMesh> meshes{
        {"one triangle", right_triangle()},
        {"pair", grid(2, 2, 1, 1, Diagonals::uniform)},
        {"grid, uniform diagonals", grid(7, 5, 1, 2, Diagonals::uniform)},
        {"grid, alternating diagonals", grid(5, 8, 1, 1, Diagonals::alternating)},
        {"grid, random diagonals", grid(9, 9, 1, 1, Diagonals::random)},
        {"tetrahedron", tetrahedron()},
        {"book of three pages", book(3)},
        {"duplicate triangles", with_duplicates(grid(3, 3, 1, 1, Diagonals::uniform))},
        {"two components", together(tetrahedron(), grid(4, 3, 1, 1, Diagonals::random))},
        {"isolated vertices", with_isolated_vertices(grid(3, 4, 1, 1, Diagonals::alternating))},
    };
    for (std::uint32_t blades = 1; blades <= 12; ++blades)
        meshes.push_back({"fan of " + std::to_string(blades), fan(blades)});
    return meshes;
}

std::vector<SampleMesh> garments() {
    const std::filesystem::path folder = APSL_SHARED_MESHES;
    if (!std::filesystem::exists(folder)) {
        WARN("../shared/meshes is absent: the garments are passed over");
        return {};
    }
    std::vector<SampleMesh> meshes;
    for (const char* name : {"skirt.obj", "tshirt.obj"}) meshes.push_back({name, read_obj((folder / name).string())});
    return meshes;
}

}  // namespace apsl::test
