// SPDX-License-Identifier: MIT
#include "support/meshes.hpp"

#include <apsl/error.hpp>
#include <apsl/reference.hpp>

#include <catch2/catch.hpp>
#include <limits>

using namespace apsl;

TEST_CASE("lumped inverse masses, by hand") {
    // Two triangles of ½ m² at 0.6 kg/m²: 0.1 kg a corner. Vertices 1 and 2 lie in both, vertex 4 in none.
    const std::vector<Triangle> triangles{{0, 2, 1}, {1, 2, 3}};
    const auto topology = Topology::build(triangles, 5);
    const std::vector<double> rest_areas{0.5, 0.5};
    const auto w = reference::inverse_masses<double>(*topology, rest_areas, 0.6);
    REQUIRE(w.size() == 5);
    CHECK(w[0] == Approx(10.0));
    CHECK(w[1] == Approx(5.0));
    CHECK(w[2] == Approx(5.0));
    CHECK(w[3] == Approx(10.0));
    CHECK(w[4] == 0.0);
}

TEST_CASE("the masses add up to area times density") {
    const test::Mesh mesh = test::grid(11, 7, 2.0, 1.5, test::Diagonals::random);
    const auto topology = Topology::build(mesh.triangles, mesh.vertex_count());
    const auto rest_areas = reference::areas<double>(*topology, mesh.positions);
    double total = 0.0;
    for (const double w : reference::inverse_masses<double>(*topology, rest_areas, 0.2)) total += 1.0 / w;
    CHECK(total == Approx(2.0 * 1.5 * 0.2));
}

TEST_CASE("lumped masses refuse what cannot weigh anything") {
    const auto topology = Topology::build(test::right_triangle().triangles, 3);
    const std::vector<double> one{1.0};
    const std::vector<double> negative{-1.0};
    const std::vector<double> two{1.0, 1.0};
    CHECK_THROWS_WITH(reference::inverse_masses<double>(*topology, one, -0.2),
                      Catch::StartsWith("density is -0.2") && Catch::EndsWith("expected a finite number > 0 (kg/m2)"));
    CHECK_THROWS_AS(reference::inverse_masses<double>(*topology, one, std::numeric_limits<double>::quiet_NaN()), Error);
    CHECK_THROWS_WITH(reference::inverse_masses<double>(*topology, negative, 0.2),
                      "rest_areas of triangle 0 is -1, expected a finite number >= 0 (m2)");
    CHECK_THROWS_WITH(reference::inverse_masses<double>(*topology, two, 0.2), "rest_areas holds 2 numbers, expected 1");
    CHECK_THROWS_WITH(reference::areas<double>(*topology, two), "positions holds 2 numbers, expected 9");
}
