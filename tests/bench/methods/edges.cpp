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

TEST_CASE("edge limits: an edge beyond a bound comes back to it, one within stays", "[methods]") {
    const Cloth cloth = cloth_of(right_triangle(), {0, 2});
    // Edge 1–2 (rest √5) within 10 % before and after; 0–1 (rest 2) too long, then too short.
    const std::vector<Eigen::Vector3f> longer{{0.0f, 0.0f, 0.0f}, {3.0f, 0.0f, 0.0f}, {1.6f, 2.0f, 0.0f}};
    const std::vector<Eigen::Vector3f> shorter{{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {1.4f, 2.1f, 0.0f}};
    for (const char* const method : {"edge_limits_gauss_seidel", "edge_limits_jacobi"}) {
        INFO(method);
        const std::vector<methods::Parameter> parameters{{"iterations", 1}, {"limit", 0.1}};
        CHECK((projected(cloth, method, longer, parameters)[1] - Eigen::Vector3f(2.2f, 0.0f, 0.0f)).norm() < 1e-6f);
        CHECK((projected(cloth, method, shorter, parameters)[1] - Eigen::Vector3f(1.8f, 0.0f, 0.0f)).norm() < 1e-6f);
    }
}

TEST_CASE("edge_limits_jacobi: two edges that pull the same way do not add up to an overshoot", "[methods]") {
    // Two triangles about the edge 0–1; its end 1 is held by the nearly equal edges 1–2 and 1–3 too.
    const Mesh needles{{{0, 1, 2}, {1, 0, 3}}, {0, 0, 0, 1, 0, 0, 0, 1e-6, 0, 0, -1e-6, 0}};
    const Cloth cloth = cloth_of(needles, {0, 2, 3});
    auto start = rest_of(cloth);
    start[1].x() = 2.0f;
    const auto moved = projected(cloth, "edge_limits_jacobi", start, {{"iterations", 1}, {"limit", 0.0}});
    CHECK(moved[1].x() == Approx(1.0f).margin(1e-5));
}

TEST_CASE("edge limits: Gauss–Seidel and Jacobi both bring a stretched grid within the limit", "[methods]") {
    const Cloth cloth = hanging_grid(9);
    for (const char* const method : {"edge_limits_gauss_seidel", "edge_limits_jacobi"}) {
        INFO(method);
        const auto moved = projected(cloth, method, stretched(cloth, 1.3f), {{"iterations", 20000}, {"limit", 0.1}});
        CHECK(greatest_edge_ratio(cloth, moved) < 1.101f);
        CHECK(greatest_edge_ratio(cloth, moved) > 1.09f);
        CHECK(least_edge_ratio(cloth, moved) > 0.899f);
    }
}

TEST_CASE("xpbd_edges: compliance leaves alpha~ / (w + alpha~) of a stretch, at any number of iterations",
          "[methods]") {
    const Cloth cloth = cloth_of(right_triangle(), {0, 2});
    // alpha = 0.01 m/N and a step of 0.1 s: alpha~ = 1 / kg = w. Half of the metre at edge 0–1 stays; 1–2 is then at
    // rest.
    const std::vector<Eigen::Vector3f> start{{0.0f, 0.0f, 0.0f}, {3.0f, 0.0f, 0.0f}, {1.5f, 2.0f, 0.0f}};
    const auto once = projected(cloth, "xpbd_edges", start, {{"iterations", 1}, {"compliance", 0.01}});
    CHECK((once[1] - Eigen::Vector3f(2.5f, 0.0f, 0.0f)).norm() < 1e-6f);
}

TEST_CASE("xpbd_edges: the multiplier keeps a compliant edge where one iteration put it", "[methods]") {
    const Mesh needle{{{0, 1, 2}}, {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1e-6, 0.0}};
    const Cloth cloth = cloth_of(needle, {0, 2});
    auto start = rest_of(cloth);
    start[1].x() = 2.0f;
    // Two edges of alpha~ = 1 / kg side by side: x = 1 + 1 / (1 + 2 w / alpha~) where they balance the inertia.
    const auto moved = projected(cloth, "xpbd_edges", start, {{"iterations", 100}, {"compliance", 0.01}});
    CHECK(moved[1].x() == Approx(4.0f / 3.0f).margin(1e-5));
}

TEST_CASE("xpbd_edges: without compliance it is pbd_edges", "[methods]") {
    const Cloth cloth = hanging_grid(9);
    const auto start = stretched(cloth, 1.2f);
    for (const double iterations : {1.0, 7.0}) {
        const auto xpbd = projected(cloth, "xpbd_edges", start, {{"iterations", iterations}});
        const auto pbd = projected(cloth, "pbd_edges", start, {{"iterations", iterations}});
        for (std::size_t v = 0; v < start.size(); ++v) CHECK((xpbd[v] - pbd[v]).norm() < 1e-5f);
    }
}

TEST_CASE("pbd_edges: enough iterations bring a stretched grid to rest lengths", "[methods]") {
    const Cloth cloth = hanging_grid(9);
    const auto moved = projected(cloth, "pbd_edges", stretched(cloth, 1.2f), {{"iterations", 640}});
    CHECK(greatest_edge_ratio(cloth, moved) < 1.01f);
    CHECK(least_edge_ratio(cloth, moved) > 0.99f);
}
