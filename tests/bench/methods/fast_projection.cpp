// SPDX-License-Identifier: MIT

#include "bench/methods/sample_cloths.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;
using Eigen::Vector3f;
using methods::Cloth;

TEST_CASE("fast_projection: one Newton step by hand", "[methods]") {
    // Right triangle, corner 1 free at (3, 0, 0). Edges 0–1 and 1–2 have C = 5/2 and √5, gradients (3, 0) and
    // 2 (3, −1) / √5: two linear equations for the step, solved by (−5/6, 0).
    const Cloth cloth = cloth_of(right_triangle(), {0, 2});
    auto start = rest_of(cloth);
    start[1].x() = 3.0f;
    auto moved = projected(cloth, "fast_projection", start, {{"iterations", 1}, {"regularization", 0}});
    CHECK((moved[1] - Vector3f(3.0f - 5.0f / 6.0f, 0.0f, 0.0f)).norm() < 1e-6f);
    moved = projected(cloth, "fast_projection", start, {{"iterations", 10}, {"tolerance", 1e-6}});
    CHECK((moved[1] - Vector3f(2.0f, 0.0f, 0.0f)).norm() < 1e-5f);
}

TEST_CASE("fast_projection: free ends share a correction by their inverse masses", "[methods]") {
    Cloth cloth = cloth_of(right_triangle());
    cloth.inverse_masses = {1.0, 3.0, 0.5};
    const std::vector<Vector3f> start{{0.1f, 0.0f, 0.3f}, {2.9f, -0.2f, 0.0f}, {0.4f, 1.2f, -0.3f}};
    const auto moved = projected(cloth, "fast_projection", start, {{"iterations", 10}});
    CHECK((first_moment(cloth, moved) - first_moment(cloth, start)).norm() < 1e-6);
    CHECK(greatest_edge_ratio(cloth, moved) < 1.0002f);
    CHECK(least_edge_ratio(cloth, moved) > 0.9998f);
}

TEST_CASE("fast_projection: a few iterations restore all edges of a grid at once", "[methods]") {
    // One pin: two would hold the bent row apart.
    const Cloth cloth = cloth_of(grid(9, 9, 1.0, 1.0, Diagonals::alternating), {40});
    const auto start = stretched(cloth, 1.02f);
    REQUIRE(greatest_edge_ratio(cloth, start) > 1.05f);
    const auto moved = projected(cloth, "fast_projection", start, {{"iterations", 5}});
    CHECK(greatest_edge_ratio(cloth, moved) < 1.0005f);
    CHECK(least_edge_ratio(cloth, moved) > 0.9995f);
}

TEST_CASE("fast_projection: edges within the tolerance end it", "[methods]") {
    const Cloth cloth = hanging_grid(5);
    auto start = rest_of(cloth);
    for (Vector3f& x : start) x *= 1.005f;
    CHECK(same_bytes(projected(cloth, "fast_projection", start, {{"tolerance", 0.0051}}), start));
    CHECK_FALSE(same_bytes(projected(cloth, "fast_projection", start, {{"tolerance", 0.0049}}), start));
}

TEST_CASE("fast_projection: without the diagonals of quads a grid shears freely", "[methods]") {
    // Columns turned by 0.2 rad: every edge along x or z keeps its length, diagonals do not.
    const Cloth cloth = hanging_grid(5);
    auto start = rest_of(cloth);
    for (Vector3f& x : start) x = {x.x() + std::sin(0.2f) * x.z(), 0.0f, std::cos(0.2f) * x.z()};
    CHECK(same_bytes(projected(cloth, "fast_projection", start, {{"quads", 1}}), start));
    CHECK_FALSE(same_bytes(projected(cloth, "fast_projection", start, {{"quads", 0}}), start));
}

TEST_CASE("fast_projection: a singular matrix leaves finite positions", "[methods]") {
    const Cloth cloth = hanging_grid(5);
    auto flat = rest_of(cloth);
    for (Vector3f& x : flat) x.z() *= 1.2f;
    auto points = std::vector<Vector3f>(flat.size(), Vector3f::Ones());
    for (const auto& start : {flat, points})
        for (const double regularization : {0.0, 1e-4})
            for (const Vector3f& x : projected(cloth, "fast_projection", start, {{"regularization", regularization}}))
                CHECK(x.allFinite());
}
