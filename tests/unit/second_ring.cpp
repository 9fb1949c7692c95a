// SPDX-License-Identifier: MIT
#include "unit/sample_meshes.hpp"

#include <apsl/topology.hpp>

#include <catch2/catch.hpp>
#include <map>
#include <set>

using namespace apsl;

namespace {

std::vector<VertexPair> pairs_two_edges_apart(const std::vector<Triangle>& triangles) {
    std::map<std::uint32_t, std::set<std::uint32_t>> neighbours;
    for (const Triangle& t : triangles)
        for (const std::uint32_t u : t)
            for (const std::uint32_t v : t)
                if (u != v) neighbours[u].insert(v);
    std::set<VertexPair> pairs;
    for (const auto& [u, around] : neighbours)
        for (const std::uint32_t middle : around)
            for (const std::uint32_t v : neighbours[middle])
                if (u < v && around.count(v) == 0) pairs.insert({u, v});
    return {pairs.begin(), pairs.end()};
}

}  // namespace

TEST_CASE("second-ring pairs agree with sets of neighbours") {
    auto samples = test::small_meshes();
    for (auto& garment : test::garments()) samples.push_back(std::move(garment));
    for (const auto& [name, mesh] : samples) {
        INFO(name);
        const auto topology = Topology::build(mesh.triangles, mesh.vertex_count());
        REQUIRE(topology->second_ring_pairs() == pairs_two_edges_apart(mesh.triangles));
    }
}

TEST_CASE("second-ring pairs known by heart") {
    const auto pairs = [](const test::Mesh& mesh) {
        return Topology::build(mesh.triangles, mesh.vertex_count())->second_ring_pairs();
    };
    CHECK(pairs(test::right_triangle()).empty());
    CHECK(pairs(test::tetrahedron()).empty());
    CHECK(pairs(test::grid(2, 2, 1, 1, test::Diagonals::uniform)) == std::vector<VertexPair>{{0, 3}});
    CHECK(pairs(test::book(3)) == std::vector<VertexPair>{{2, 3}, {2, 4}, {3, 4}});
    // A strip 0-1-2-3: the ends of the fan of three blades are three edges apart along the rim, two through the hub.
    CHECK(pairs(test::fan(3)) == std::vector<VertexPair>{{1, 3}, {1, 4}, {2, 4}});
}
