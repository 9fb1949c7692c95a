// SPDX-License-Identifier: MIT
#include "pipeline/springs.hpp"
#include "support/meshes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <set>

using namespace apsl;
using namespace apsl::scenes;

namespace {

std::shared_ptr<const Topology> topology_of(const test::Mesh& mesh) {
    return Topology::build(mesh.triangles, mesh.vertex_count());
}

StandAloneSprings springs_of(const test::Mesh& mesh) {
    return stand_alone_springs(*topology_of(mesh), mesh.positions, 200.0);
}

// Parts that springs leave the vertices in, by spreading one label: slow and plain, to check connected_parts with.
std::size_t parts_by_spreading(std::size_t vertex_count, const std::vector<Spring>& springs) {
    std::vector<std::size_t> label(vertex_count);
    for (std::size_t vertex = 0; vertex < vertex_count; ++vertex) label[vertex] = vertex;
    for (bool changed = true; changed;) {
        changed = false;
        for (const Spring& spring : springs) {
            const std::size_t least = std::min(label[spring.a], label[spring.b]);
            changed = changed || label[spring.a] != least || label[spring.b] != least;
            label[spring.a] = label[spring.b] = least;
        }
    }
    return std::set<std::size_t>(label.begin(), label.end()).size();
}

}  // namespace

TEST_CASE("stand-alone springs: bending springs on alternating diagonals make three lattices, and all are joined") {
    const test::Mesh mesh = test::grid(9, 9, 1.0, 1.0, test::Diagonals::alternating);
    const auto topology = topology_of(mesh);
    CHECK(connected_parts(*topology, bending_springs(*topology, mesh.positions, 1.0)) == 3);
    const StandAloneSprings made = springs_of(mesh);
    CHECK(made.lattices == 3);
    CHECK(made.between_lattices > 0);
    CHECK(made.connecting == 0);
    CHECK(made.springs.size() == made.bending + made.second_ring + made.between_lattices);
    CHECK(connected_parts(*topology, made.springs) == 1);
    CHECK(parts_by_spreading(mesh.vertex_count(), made.springs) == 1);
}

TEST_CASE("stand-alone springs: none lies along an edge of a grid, and none is given twice but by bending") {
    for (const auto diagonals : {test::Diagonals::uniform, test::Diagonals::alternating, test::Diagonals::random}) {
        const test::Mesh mesh = test::grid(8, 7, 1.0, 1.0, diagonals);
        const auto topology = topology_of(mesh);
        const StandAloneSprings made = springs_of(mesh);
        std::set<VertexPair> added;
        for (std::size_t i = 0; i < made.springs.size(); ++i) {
            const VertexPair pair{made.springs[i].a, made.springs[i].b};
            CHECK_FALSE(std::binary_search(topology->edges().begin(), topology->edges().end(), pair));
            CHECK((i < made.bending || added.insert(pair).second));
        }
    }
}

TEST_CASE("stand-alone springs: every vertex of a grid is held in two directions, corners included") {
    for (const auto diagonals : {test::Diagonals::uniform, test::Diagonals::alternating, test::Diagonals::random}) {
        const test::Mesh mesh = test::grid(6, 6, 1.0, 1.0, diagonals);
        const StandAloneSprings made = springs_of(mesh);
        // Directions as columns (x, z) of a 2×n matrix: rank 2 where the determinant of its square is not zero.
        std::vector<double> xx(36, 0.0), xz(36, 0.0), zz(36, 0.0);
        for (const Spring& spring : made.springs) {
            const double x = (mesh.positions[3 * spring.b] - mesh.positions[3 * spring.a]) / spring.rest_length;
            const double z = (mesh.positions[3 * spring.b + 2] - mesh.positions[3 * spring.a + 2]) / spring.rest_length;
            for (const std::uint32_t vertex : {spring.a, spring.b}) {
                xx[vertex] += x * x;
                xz[vertex] += x * z;
                zz[vertex] += z * z;
            }
        }
        for (std::size_t vertex = 0; vertex < 36; ++vertex)
            CHECK(xx[vertex] * zz[vertex] - xz[vertex] * xz[vertex] > 0.1);
    }
}

TEST_CASE("stand-alone springs: patches too small for a second ring are joined along edges") {
    const test::Mesh triangle = test::right_triangle();
    const StandAloneSprings one = springs_of(triangle);
    CHECK(one.bending == 0);
    CHECK(one.lattices == 3);
    CHECK(one.connecting == 3);
    CHECK(connected_parts(*topology_of(triangle), one.springs) == 1);

    const test::Mesh quad = test::grid(2, 2, 1.0, 1.0, test::Diagonals::uniform);
    const StandAloneSprings two = springs_of(quad);
    CHECK(two.bending == 1);
    CHECK(two.lattices == 3);
    CHECK(connected_parts(*topology_of(quad), two.springs) == 1);
}

TEST_CASE("stand-alone springs: components stay apart, vertices in no triangle stay alone") {
    test::Mesh mesh = test::together(test::grid(5, 5, 1.0, 1.0, test::Diagonals::alternating),
                                     test::grid(4, 6, 1.0, 1.0, test::Diagonals::uniform));
    mesh.positions.insert(mesh.positions.end(), {50.0, 0.0, 0.0});
    const StandAloneSprings made = springs_of(mesh);
    CHECK(connected_parts(*topology_of(mesh), made.springs) == 2);
    CHECK(parts_by_spreading(mesh.vertex_count(), made.springs) == 3);
}

TEST_CASE("stand-alone springs: the garments are held together") {
    for (const std::string name : {"skirt.obj", "tshirt.obj"}) {
        const std::string path = std::string(APSL_SHARED_MESHES) + "/" + name;
        if (!std::filesystem::exists(path)) {
            WARN("../shared/meshes/" << name << " is not there; passed over");
            continue;
        }
        const test::Mesh mesh = test::read_obj(path);
        const auto topology = topology_of(mesh);
        const StandAloneSprings made = springs_of(mesh);
        CHECK(connected_parts(*topology, made.springs) == topology->component_count());
        CHECK(made.bending >= topology->edges().size() - topology->boundary_edge_count());
    }
}
