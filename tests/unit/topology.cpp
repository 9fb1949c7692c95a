// SPDX-License-Identifier: MIT
//
// Incidence and counts against plain maps and sets.

#include "unit/sample_meshes.hpp"

#include <apsl/topology.hpp>

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>

using namespace apsl;

namespace {

/// Corners opposite each edge, from a map.
std::map<VertexPair, std::vector<Corner>> corners_by_edge(const std::vector<Triangle>& triangles) {
    std::map<VertexPair, std::vector<Corner>> result;
    for (std::uint32_t a = 0; a < triangles.size(); ++a)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t u = triangles[a][(k + 1) % 3];
            const std::uint32_t v = triangles[a][(k + 2) % 3];
            result[{std::min(u, v), std::max(u, v)}].push_back(3 * a + k);
        }
    return result;
}

/// Components by painting: every triangle pulls its vertices down to the least colour among them, until nothing moves.
std::size_t component_count(const test::Mesh& mesh) {
    std::vector<std::size_t> colour(mesh.vertex_count());
    for (std::size_t v = 0; v < colour.size(); ++v) colour[v] = v;
    for (bool changed = true; changed;) {
        changed = false;
        for (const Triangle& t : mesh.triangles) {
            const std::size_t least = std::min({colour[t[0]], colour[t[1]], colour[t[2]]});
            for (const std::uint32_t v : t) {
                changed = changed || colour[v] != least;
                colour[v] = least;
            }
        }
    }
    std::set<std::size_t> colours;
    for (const Triangle& t : mesh.triangles) colours.insert(colour[t[0]]);
    return colours.size();
}

void check_topology(const test::SampleMesh& sample) {
    INFO(sample.name);
    const test::Mesh& mesh = sample.mesh;
    const auto topology = Topology::build(mesh.triangles, mesh.vertex_count());

    REQUIRE(topology->vertex_count() == mesh.vertex_count());
    REQUIRE(topology->triangle_count() == mesh.triangles.size());
    REQUIRE(std::equal(mesh.triangles.begin(), mesh.triangles.end(), topology->triangles().begin()));

    std::map<std::uint32_t, std::vector<Corner>> by_vertex;
    for (std::uint32_t corner = 0; corner < 3 * mesh.triangles.size(); ++corner)
        by_vertex[mesh.triangles[corner / 3][corner % 3]].push_back(corner);
    REQUIRE(topology->corner_offsets().size() == mesh.vertex_count() + 1);
    REQUIRE(topology->corner_offsets()[0] == 0);
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        const auto begin = topology->corners().begin() + topology->corner_offsets()[v];
        const auto end = topology->corners().begin() + topology->corner_offsets()[v + 1];
        REQUIRE(std::vector<Corner>(begin, end) == by_vertex[v]);
    }
    REQUIRE(topology->corners().size() == 3 * mesh.triangles.size());
    REQUIRE(topology->isolated_vertex_count() ==
            static_cast<std::size_t>(std::count_if(by_vertex.begin(), by_vertex.end(),
                                                   [](const auto& entry) { return entry.second.empty(); })));

    const auto by_edge = corners_by_edge(mesh.triangles);
    REQUIRE(topology->edges().size() == by_edge.size());
    REQUIRE(topology->edge_corner_offsets().size() == by_edge.size() + 1);
    REQUIRE(topology->edge_corners().size() == 3 * mesh.triangles.size());
    std::size_t e = 0;
    std::size_t boundary = 0;
    std::size_t non_manifold = 0;
    for (const auto& [edge, corners] : by_edge) {
        REQUIRE(topology->edges()[e] == edge);
        const auto begin = topology->edge_corners().begin() + topology->edge_corner_offsets()[e];
        const auto end = topology->edge_corners().begin() + topology->edge_corner_offsets()[e + 1];
        REQUIRE(std::vector<Corner>(begin, end) == corners);
        boundary += corners.size() == 1 ? 1 : 0;
        non_manifold += corners.size() > 2 ? 1 : 0;
        ++e;
    }
    REQUIRE(topology->boundary_edge_count() == boundary);
    REQUIRE(topology->non_manifold_edge_count() == non_manifold);
    REQUIRE(topology->component_count() == component_count(mesh));
}

}  // namespace

TEST_CASE("topology agrees with maps and sets on every kind of small mesh") {
    for (const auto& sample : test::small_meshes()) check_topology(sample);
}

TEST_CASE("topology agrees with maps and sets on the garments") {
    for (const auto& sample : test::garments()) check_topology(sample);
}

TEST_CASE("topology counts of meshes known by heart") {
    const auto build = [](const test::Mesh& mesh) { return Topology::build(mesh.triangles, mesh.vertex_count()); };

    const auto tetrahedron = build(test::tetrahedron());
    CHECK(tetrahedron->edges().size() == 6);
    CHECK(tetrahedron->boundary_edge_count() == 0);
    CHECK(tetrahedron->non_manifold_edge_count() == 0);
    CHECK(tetrahedron->component_count() == 1);

    const auto book = build(test::book(3));
    CHECK(book->edges().size() == 7);
    CHECK(book->non_manifold_edge_count() == 1);
    CHECK(book->boundary_edge_count() == 6);

    // 7 × 5 vertices: 6·5 + 7·4 sides and 6·4 diagonals; the rim has 2·(6 + 4) of them.
    const auto grid = build(test::grid(7, 5, 1, 1, test::Diagonals::alternating));
    CHECK(grid->triangle_count() == 48);
    CHECK(grid->edges().size() == 82);
    CHECK(grid->boundary_edge_count() == 20);

    CHECK(build(test::together(test::book(3), test::tetrahedron()))->component_count() == 2);
    CHECK(Topology::build(test::right_triangle().triangles, 10)->isolated_vertex_count() == 7);
}
