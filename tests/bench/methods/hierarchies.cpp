// SPDX-License-Identifier: MIT
//
// The hierarchy of Müller 2008 and the two methods upon it.

#include "bench/methods/sample_cloths.hpp"
#include "methods/coarsening.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;
using Eigen::Vector3f;
using methods::Cloth;
using methods::coarsen;
using methods::Level;

TEST_CASE("coarsen: a triangle by hand", "[methods]") {
    // Corner 0 goes first; its parents lie 3 and 1 away. Then 1 and 2 have one neighbour each, too few to spare.
    const Cloth cloth = cloth_of({{{0, 1, 2}}, {0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 1.0, 0.0}});
    const std::vector<Level> levels = coarsen(cloth, 5);
    REQUIRE(levels.size() == 2);
    CHECK(levels[0].fine_vertices == std::vector<std::uint32_t>{0});
    CHECK(levels[0].parents == std::vector<std::uint32_t>{1, 2});
    CHECK(levels[0].weights[0] == Approx(0.25));
    CHECK(levels[0].weights[1] == Approx(0.75));
    CHECK(levels[1].vertices == std::vector<std::uint32_t>{1, 2});
    REQUIRE(levels[1].edges == std::vector<VertexPair>{{1, 2}});
    CHECK(levels[1].rest_lengths[0] == Approx(std::sqrt(10.0)));

    const std::vector<Vector3f> before(3, Vector3f::Zero());
    std::vector<Vector3f> positions{{5.0f, 0.0f, 0.0f}, {4.0f, 0.0f, 0.0f}, {0.0f, 8.0f, 0.0f}};
    interpolate(levels[0], before, positions);
    CHECK((positions[0] - Vector3f(6.0f, 6.0f, 0.0f)).norm() < 1e-6f);
}

TEST_CASE("coarsen: each fine vertex has two coarse parents or more, pinned vertices stay", "[methods]") {
    const Cloth cloth = cloth_of(grid(14, 11, 1.0, 1.0, Diagonals::random), {0, 13, 77, 78});
    const std::vector<Level> levels = coarsen(cloth, 6);
    REQUIRE(levels.size() >= 4);
    for (std::size_t l = 0; l + 1 < levels.size(); ++l) {
        const Level& level = levels[l];
        const std::vector<std::uint32_t>& coarser = levels[l + 1].vertices;
        const auto is_coarse = [&](std::uint32_t v) { return std::ranges::binary_search(coarser, v); };
        CHECK(level.vertices.size() == level.fine_vertices.size() + coarser.size());
        CHECK(std::ranges::none_of(level.fine_vertices, is_coarse));
        for (std::size_t n = 0; n < level.fine_vertices.size(); ++n) {
            CHECK(cloth.inverse_masses[level.fine_vertices[n]] > 0.0);
            CHECK(level.parent_offsets[n + 1] - level.parent_offsets[n] >= 2);
            float sum = 0.0f;
            for (std::uint32_t p = level.parent_offsets[n]; p < level.parent_offsets[n + 1]; ++p) {
                CHECK(is_coarse(level.parents[p]));
                sum += level.weights[p];
            }
            CHECK(sum == Approx(1.0f).margin(1e-6));
        }
        for (const auto& [a, b] : levels[l + 1].edges) {
            CHECK(a < b);
            CHECK((is_coarse(a) && is_coarse(b)));
        }
    }
}

TEST_CASE("hierarchical_pbd: on one level it is PBD on edges", "[methods]") {
    const Cloth cloth = hanging_grid(9);
    const auto start = stretched(cloth, 1.2f);
    const auto hierarchical = projected(cloth, "hierarchical_pbd", start, {{"iterations", 7}, {"levels", 1}});
    const auto plain = projected(cloth, "pbd_edges", start, {{"iterations", 7}});
    for (std::size_t v = 0; v < start.size(); ++v) CHECK((hierarchical[v] - plain[v]).norm() < 1e-5f);
    CHECK((hierarchical[40] - start[40]).norm() > 1e-3f);
}

TEST_CASE("hierarchical_pbd: coarse levels resist stretching and let folds be", "[methods]") {
    // Two levels of one triangle. Between the pins 1 and 2 only vertex 0 could move, and the coarse edge 1–2, free
    // here, is too long in one start and too short in the other; interpolation would carry vertex 0 along.
    const Cloth cloth = cloth_of({{{0, 1, 2}}, {0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 1.0, 0.0}});
    const auto rest = rest_of(cloth);
    const auto first_edge = [&](float factor, double levels) {
        auto start = rest;
        start[1].x() *= factor;
        return projected(cloth, "hierarchical_pbd", start, {{"iterations", 1}, {"levels", levels}});
    };
    CHECK(same_bytes(first_edge(0.8f, 1.0), first_edge(0.8f, 2.0)));
    CHECK_FALSE(same_bytes(first_edge(1.2f, 1.0), first_edge(1.2f, 2.0)));
}

TEST_CASE("hierarchies: more levels reach further in the same iterations", "[methods]") {
    const Cloth cloth = hanging_grid(33);
    const auto start = stretched(cloth, 1.2f);
    const auto ratio = [&](const std::string& method, double levels) {
        return greatest_edge_ratio(cloth, projected(cloth, method, start, {{"iterations", 10}, {"levels", levels}}));
    };
    CHECK(ratio("hierarchical_pbd", 6) < 0.85f * ratio("hierarchical_pbd", 1));
    CHECK(ratio("hierarchical_constraints", 6) < 0.85f * ratio("hierarchical_constraints", 1));
}

TEST_CASE("hierarchies: enough iterations restore a stretched grid", "[methods]") {
    const Cloth cloth = hanging_grid(9);
    const auto start = stretched(cloth, 1.2f);
    for (const auto& moved : {projected(cloth, "hierarchical_pbd", start, {{"iterations", 320}, {"levels", 3}}),
                              projected(cloth, "hierarchical_constraints", start, {{"levels", 3}, {"passes", 40}})}) {
        CHECK(greatest_edge_ratio(cloth, moved) < 1.02f);
        CHECK(least_edge_ratio(cloth, moved) > 0.98f);
    }
}

TEST_CASE("hierarchical_constraints: one level is one damped solve for the multipliers of all edges", "[methods]") {
    // Right triangle, corner 1 free at (3, 0, 0) between two pins: edges 0–1 and 1–2 pull along (1, 0) and (3, −1) /
    // √10.
    const Cloth cloth = cloth_of(right_triangle(), {0, 2});
    auto start = rest_of(cloth);
    start[1].x() = 3.0f;
    const auto moved =
        projected(cloth, "hierarchical_constraints", start, {{"iterations", 2}, {"levels", 1}, {"passes", 1}});
    Eigen::Matrix2d jacobian;
    jacobian << 1.0, 0.0, 3.0 / std::sqrt(10.0), -1.0 / std::sqrt(10.0);
    const Eigen::Vector2d constraints(1.0, std::sqrt(10.0) - std::sqrt(5.0));
    const Eigen::Matrix2d damped = jacobian * jacobian.transpose() + 0.05 * Eigen::Matrix2d::Identity();
    const Eigen::Vector2d step = -jacobian.transpose() * damped.inverse() * constraints;
    CHECK(moved[1].x() == Approx(3.0 + step[0]).margin(1e-5));
    CHECK(moved[1].y() == Approx(step[1]).margin(1e-5));
}

TEST_CASE("hierarchies: without coarse levels momentum is conserved", "[methods]") {
    Cloth cloth = cloth_of(grid(9, 9, 1.0, 1.0, Diagonals::alternating));
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); v += 3) cloth.inverse_masses[v] = 2.5;
    const auto start = stretched(cloth, 1.2f);
    for (const std::string method : {"hierarchical_pbd", "hierarchical_constraints"}) {
        const auto moved = projected(cloth, method, start, {{"levels", 1}});
        CHECK((moved[0] - start[0]).norm() > 1e-3f);
        CHECK((first_moment(cloth, moved) - first_moment(cloth, start)).norm() < 1e-4);
    }
}
