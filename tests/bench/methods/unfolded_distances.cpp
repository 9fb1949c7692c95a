// SPDX-License-Identifier: MIT
#include "methods/unfolded_distances.hpp"

#include "bench/methods/sample_cloths.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;
using methods::Cloth;
using methods::PinDistance;
using methods::unfolded_distances;

TEST_CASE("ways to a pin are straight on a flat sheet", "[methods]") {
    for (const Diagonals diagonals : {Diagonals::uniform, Diagonals::alternating, Diagonals::random}) {
        const Cloth cloth = cloth_of(grid(13, 9, 2.0, 1.0, diagonals), {0});
        const auto islands = unfolded_distances(cloth);
        REQUIRE(islands.size() == 1);
        REQUIRE(islands[0].size() == 13 * 9 - 1);
        for (const PinDistance& way : islands[0]) {
            CAPTURE(way.vertex);
            const double straight = (cloth.rest_positions[way.vertex] - cloth.rest_positions[0]).norm();
            CHECK(way.pin == 0);
            CHECK(way.length == Approx(straight).epsilon(1e-9));
        }
    }
}

TEST_CASE("ways to a pin go over folds as if these were flat", "[methods]") {
    Cloth cloth = cloth_of(grid(9, 9, 1.0, 1.0, Diagonals::alternating), {0});
    const std::vector<Eigen::Vector3d> flat = cloth.rest_positions;
    for (Eigen::Vector3d& x : cloth.rest_positions)
        if (x.x() > 0.0) x = {0.0, x.x(), x.z()};  // folded up along the middle column
    const auto islands = unfolded_distances(cloth);
    for (const PinDistance& way : islands.at(0))
        CHECK(way.length == Approx((flat[way.vertex] - flat[0]).norm()).epsilon(1e-9));
}

TEST_CASE("ways to a pin go around what is not there", "[methods]") {
    // Without the quarter x > 0, z < 0: from the corner (−½, −½) to (0, ½) straight, to (½, 0) around the middle.
    Mesh mesh = grid(9, 9, 1.0, 1.0, Diagonals::alternating);
    std::erase_if(mesh.triangles, [&](const Triangle& triangle) {
        double x = 0.0;
        double z = 0.0;
        for (const std::uint32_t v : triangle) {
            x += mesh.positions[3 * v];
            z += mesh.positions[3 * v + 2];
        }
        return x > 0.0 && z < 0.0;
    });
    const auto islands = unfolded_distances(cloth_of(mesh, {0}));
    for (const PinDistance& way : islands.at(0)) {
        if (way.vertex == 76) CHECK(way.length == Approx(std::sqrt(1.25)));
        if (way.vertex == 44) CHECK(way.length == Approx(std::sqrt(0.5) + 0.5));
        CHECK(way.vertex != 8);  // in no triangle
    }
}

TEST_CASE("pins that edges connect are one island, each vertex has the nearest of them", "[methods]") {
    const auto islands = unfolded_distances(cloth_of(grid(5, 3, 1.0, 1.0, Diagonals::uniform), {0, 1, 4}));
    REQUIRE(islands.size() == 2);
    REQUIRE(islands[0].size() == 12);
    for (const PinDistance& way : islands[0]) {
        CHECK(way.pin == (way.vertex % 5 == 0 ? 0 : 1));
        if (way.vertex == 6) CHECK(way.length == Approx(0.5));
        if (way.vertex == 2) CHECK(way.length == Approx(0.25));
    }
    for (const PinDistance& way : islands[1]) CHECK(way.pin == 4);
    CHECK(unfolded_distances(cloth_of(right_triangle())).empty());
}

TEST_CASE("no way leads to another piece", "[methods]") {
    const auto islands = unfolded_distances(cloth_of(together(right_triangle(), right_triangle()), {0}));
    REQUIRE(islands.size() == 1);
    REQUIRE(islands[0].size() == 2);
    CHECK(islands[0][0].length == Approx(2.0));
    CHECK(islands[0][1].length == Approx(1.0));
}
