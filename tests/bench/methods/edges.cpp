// SPDX-License-Identifier: MIT
//
// Methods that hold edges, against values by hand. The right triangle (0,0,0), (2,0,0), (0,1,0) has the edges 0–1, 0–2
// and 1–2, in this order. The hand values place vertices so that once 0–1 is done, the other two are at rest.

#include "bench/methods/sample_cloths.hpp"

#include <catch2/catch.hpp>

using namespace apsl;
using namespace apsl::test;
using methods::Cloth;

TEST_CASE("pbd_edges: with one end pinned, one iteration brings an edge to its rest length", "[methods]") {
    const Cloth cloth = cloth_of(right_triangle(), {0, 2});
    auto start = rest_of(cloth);
    start[1].x() = 3.0f;
    const auto moved = projected(cloth, "pbd_edges", start, {{"iterations", 1}});
    CHECK((moved[1] - Eigen::Vector3f(2.0f, 0.0f, 0.0f)).norm() < 1e-6f);
}

TEST_CASE("pbd_edges: free ends share a correction by their inverse masses", "[methods]") {
    Cloth cloth = cloth_of(right_triangle(), {2});
    cloth.inverse_masses[1] = 3.0;
    const std::vector<Eigen::Vector3f> start{{0.0f, 0.0f, 0.0f}, {3.0f, 0.0f, 0.0f}, {0.25f, 1.0f, 0.0f}};
    const auto moved = projected(cloth, "pbd_edges", start, {{"iterations", 1}});
    CHECK((moved[0] - Eigen::Vector3f(0.25f, 0.0f, 0.0f)).norm() < 1e-6f);
    CHECK((moved[1] - Eigen::Vector3f(2.25f, 0.0f, 0.0f)).norm() < 1e-6f);
}

TEST_CASE("pbd_edges: stiffness means the same at any number of iterations", "[methods]") {
    // A slender triangle: both edges at vertex 1 pull along x alone, and what is left after n iterations is (1 − k)^2
    // whatever n, as each iteration meets both.
    const Mesh needle{{{0, 1, 2}}, {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1e-6, 0.0}};
    const Cloth cloth = cloth_of(needle, {0, 2});
    auto start = rest_of(cloth);
    start[1].x() = 2.0f;
    for (const double iterations : {1.0, 2.0, 5.0}) {
        const auto moved = projected(cloth, "pbd_edges", start, {{"iterations", iterations}, {"stiffness", 0.5}});
        CHECK(moved[1].x() == Approx(1.25f).margin(1e-5));
    }
}

TEST_CASE("pbd_edges: enough iterations bring a stretched grid to rest lengths", "[methods]") {
    const Cloth cloth = hanging_grid(9);
    const auto moved = projected(cloth, "pbd_edges", stretched(cloth, 1.2f), {{"iterations", 640}});
    CHECK(greatest_edge_ratio(cloth, moved) < 1.01f);
    CHECK(least_edge_ratio(cloth, moved) > 0.99f);
}
