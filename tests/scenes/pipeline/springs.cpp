// SPDX-License-Identifier: MIT
#include "pipeline/springs.hpp"

#include "support/meshes.hpp"

#include <apsl/error.hpp>
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace apsl;
using namespace apsl::scenes;

namespace {

std::shared_ptr<const Topology> topology_of(const test::Mesh& mesh) {
    return Topology::build(mesh.triangles, mesh.vertex_count());
}

}  // namespace

TEST_CASE("springs: a grid has one stretch spring an edge and one bending spring an interior edge") {
    for (const auto diagonals : {test::Diagonals::uniform, test::Diagonals::alternating, test::Diagonals::random}) {
        const std::size_t columns = 7, rows = 5;
        const test::Mesh mesh = test::grid(columns, rows, 0.6, 0.4, diagonals);
        const auto topology = topology_of(mesh);
        const std::size_t cells = (columns - 1) * (rows - 1);
        const std::size_t edges = (columns - 1) * rows + columns * (rows - 1) + cells;
        const std::size_t boundary = 2 * (columns - 1) + 2 * (rows - 1);
        CHECK(stretch_springs(*topology, mesh.positions, 20.0).size() == edges);
        CHECK(bending_springs(*topology, mesh.positions, 20.0).size() == edges - boundary);
    }
}

TEST_CASE("springs: lengths are those at rest, the stiffness is as given, ends are in order") {
    const test::Mesh mesh = test::grid(3, 2, 0.2, 0.1, test::Diagonals::uniform);
    for (const Spring& spring : stretch_springs(*topology_of(mesh), mesh.positions, 20.0)) {
        const double axis = 0.1, diagonal = 0.1 * std::sqrt(2.0);
        CHECK((std::abs(spring.rest_length - axis) < 1e-15 || std::abs(spring.rest_length - diagonal) < 1e-15));
        CHECK(spring.stiffness == 20.0);
        CHECK(spring.a < spring.b);
    }
}

TEST_CASE("springs: two triangles have one bending spring between the far corners") {
    const test::Mesh mesh = test::grid(2, 2, 1.0, 1.0, test::Diagonals::uniform);
    const auto topology = topology_of(mesh);
    const auto springs = bending_springs(*topology, mesh.positions, 5.0);
    REQUIRE(springs.size() == 1);
    CHECK(springs[0].rest_length == Approx(std::sqrt(2.0)).epsilon(1e-15));
    for (const auto& [a, b] : topology->edges()) CHECK((springs[0].a != a || springs[0].b != b));
}

TEST_CASE("springs: three pages at one edge give a bending spring for each pair of pages") {
    const test::Mesh mesh = test::book(3);
    const auto springs = bending_springs(*topology_of(mesh), mesh.positions, 5.0);
    REQUIRE(springs.size() == 3);
    for (const Spring& spring : springs) {
        CHECK(spring.a >= 2);
        CHECK(spring.rest_length == Approx(std::sqrt(3.0)).epsilon(1e-14));
    }
}

TEST_CASE("springs: one triangle bends nowhere, and neither does the same triangle given twice") {
    const test::Mesh mesh = test::right_triangle();
    CHECK(bending_springs(*topology_of(mesh), mesh.positions, 5.0).empty());
    const test::Mesh twice{{{0, 1, 2}, {0, 1, 2}}, mesh.positions};
    CHECK(bending_springs(*topology_of(twice), mesh.positions, 5.0).empty());
}

TEST_CASE("springs: a wrong size or stiffness is an error") {
    const test::Mesh mesh = test::right_triangle();
    const auto topology = topology_of(mesh);
    CHECK_THROWS_WITH(stretch_springs(*topology, std::vector<double>(8), 1.0), Catch::Contains("expected 9"));
    for (const double stiffness : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
        CHECK_THROWS_WITH(stretch_springs(*topology, mesh.positions, stiffness), Catch::Contains("stiffness"));
        CHECK_THROWS_WITH(bending_springs(*topology, mesh.positions, stiffness), Catch::Contains("stiffness"));
        CHECK_THROWS_WITH(stand_alone_springs(*topology, mesh.positions, stiffness), Catch::Contains("stiffness"));
    }
}
