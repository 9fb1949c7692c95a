// SPDX-License-Identifier: MIT
#include "methods/greedy_coloring.hpp"

#include "support/meshes.hpp"

#include <apsl/topology.hpp>

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

using namespace apsl;
using namespace apsl::test;
using methods::Coloring;
using methods::greedy_coloring;

namespace {

template <class Tuple>
void check_valid(const std::vector<Tuple>& constraints, const Coloring& coloring) {
    std::vector<std::uint32_t> numbers = coloring.order;
    std::ranges::sort(numbers);
    REQUIRE(numbers.size() == constraints.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) CHECK(numbers[i] == i);
    for (std::size_t color = 0; color < coloring.color_count(); ++color) {
        std::set<std::uint32_t> vertices;
        std::size_t named = 0;
        for (std::uint32_t i = coloring.offsets[color]; i < coloring.offsets[color + 1]; ++i)
            for (const std::uint32_t v : constraints[coloring.order[i]]) {
                vertices.insert(v);
                ++named;
            }
        CHECK(named > 0);
        CHECK(vertices.size() == named);
    }
}

template <class Tuple>
Coloring color(const std::vector<Tuple>& constraints, std::size_t vertex_count) {
    return greedy_coloring(constraints.size(), vertex_count, [&](std::size_t i) { return std::span(constraints[i]); });
}

}  // namespace

TEST_CASE("greedy_coloring: no two of a color share a vertex", "[methods]") {
    for (const Mesh& mesh : {grid(6, 7, 1, 1, Diagonals::random), tetrahedron(), book(5), fan(12)}) {
        const auto topology = Topology::build(mesh.triangles, mesh.vertex_count());
        const std::vector<VertexPair> edges(topology->edges().begin(), topology->edges().end());
        check_valid(edges, color(edges, mesh.vertex_count()));
        check_valid(mesh.triangles, color(mesh.triangles, mesh.vertex_count()));
    }
}

TEST_CASE("greedy_coloring: a path needs two colors, a fan one for each blade, nothing none", "[methods]") {
    const std::vector<VertexPair> path{{0, 1}, {1, 2}, {2, 3}, {3, 4}};
    const Coloring coloring = color(path, 5);
    CHECK(coloring.offsets == std::vector<std::uint32_t>{0, 2, 4});
    CHECK(coloring.order == std::vector<std::uint32_t>{0, 2, 1, 3});
    CHECK(color(fan(9).triangles, fan(9).vertex_count()).color_count() == 9);
    CHECK(color(std::vector<VertexPair>{}, 5).color_count() == 0);
}
