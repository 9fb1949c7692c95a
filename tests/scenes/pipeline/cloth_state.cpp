// SPDX-License-Identifier: MIT
#include "pipeline/cloth_state.hpp"

#include "sample_cloth.hpp"

#include <apsl/error.hpp>
#include <catch2/catch.hpp>

#include <limits>
#include <numeric>

using namespace apsl;
using namespace apsl::scenes;

TEST_CASE("cloth: one triangle of 1 m² puts a third of its mass on each vertex") {
    const ClothState cloth = sample_cloth(test::right_triangle(), {1});
    CHECK(cloth.rest_areas == std::vector<double>{1.0});
    for (int vertex = 0; vertex < 3; ++vertex) CHECK(cloth.masses[vertex] == Approx(0.2 / 3.0).epsilon(1e-15));
    CHECK(cloth.inverse_masses[0] == Approx(15.0).epsilon(1e-15));
    CHECK(cloth.inverse_masses[1] == 0.0);
    CHECK(cloth.velocities == std::vector<double>(9, 0.0));
    CHECK(cloth.positions == test::right_triangle().positions);
}

TEST_CASE("cloth: the masses of a grid add up to density times area") {
    const ClothState cloth = sample_cloth(test::grid(9, 5, 2.0, 1.5, test::Diagonals::random), {0, 0, 3});
    CHECK(std::accumulate(cloth.masses.begin(), cloth.masses.end(), 0.0) == Approx(0.2 * 3.0).epsilon(1e-13));
    CHECK(cloth.inverse_masses[0] == 0.0);
    CHECK(cloth.inverse_masses[3] == 0.0);
    CHECK(cloth.inverse_masses[1] * cloth.masses[1] == Approx(1.0).epsilon(1e-15));
}

TEST_CASE("cloth: a vertex in no triangle has no mass and cannot move") {
    test::Mesh mesh = test::right_triangle();
    mesh.positions.insert(mesh.positions.end(), {7.0, 7.0, 7.0});
    const ClothState cloth = sample_cloth(mesh);
    CHECK(cloth.masses[3] == 0.0);
    CHECK(cloth.inverse_masses[3] == 0.0);
}

TEST_CASE("cloth: what cannot be a cloth is an error that names the vertex or the field") {
    const test::Mesh mesh = test::right_triangle();
    const auto topology = Topology::build(mesh.triangles, 3);
    const std::vector<std::uint32_t> none;
    CHECK_THROWS_WITH(make_cloth_state(nullptr, mesh.positions, 0.2, none), Catch::Contains("topology"));
    CHECK_THROWS_WITH(make_cloth_state(topology, std::vector<double>(6), 0.2, none), Catch::Contains("9"));
    for (const double density :
         {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        CHECK_THROWS_WITH(make_cloth_state(topology, mesh.positions, density, none), Catch::Contains("density"));
    }
    CHECK_THROWS_WITH(make_cloth_state(topology, mesh.positions, 0.2, std::vector<std::uint32_t>{3}),
                      Catch::Contains("pinned vertex 3"));
    std::vector<double> not_finite = mesh.positions;
    not_finite[5] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(make_cloth_state(topology, not_finite, 0.2, none), Catch::Contains("vertex 1"));
    CHECK_THROWS_WITH(make_cloth_state(topology, std::vector<double>(9, 0.0), 0.2, none), Catch::Contains("no mass"));
    const std::vector<std::uint32_t> all{0, 1, 2};
    CHECK_NOTHROW(make_cloth_state(topology, std::vector<double>(9, 0.0), 0.2, all));
}
