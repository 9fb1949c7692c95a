// SPDX-License-Identifier: MIT
//
// Methods that hold areas, against values by hand.

#include "bench/methods/sample_cloths.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;
using methods::Cloth;

namespace {

const char* const one_by_one[] = {"pbd_area_gauss_seidel", "pbd_area_colored", "pbd_area_jacobi", "xpbd_area"};
const char* const all_of_them[] = {"pbd_area_gauss_seidel", "pbd_area_colored", "pbd_area_jacobi", "xpbd_area",
                                   "ring_area"};

Mesh equilateral_triangle() {
    const double h = std::sqrt(0.75);
    return {{{0, 1, 2}}, {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.5, h, 0.0}};
}

}  // namespace

TEST_CASE("Area: over a pinned base, area is linear in the height, and one iteration is exact", "[methods]") {
    const Cloth cloth = cloth_of(right_triangle(), {0, 1});
    auto start = rest_of(cloth);
    for (const float height : {1.5f, 0.25f}) {
        start[2].y() = height;
        for (const char* const method : all_of_them) {
            INFO(method);
            const auto moved = projected(cloth, method, start, {{"iterations", 1}});
            CHECK((moved[2] - Eigen::Vector3f(0.0f, 1.0f, 0.0f)).norm() < 1e-6f);
        }
    }
}

TEST_CASE("Area: an equilateral triangle's side follows Newton's method, s - (s^2 - 1) / (2 s)", "[methods]") {
    const Cloth cloth = cloth_of(equilateral_triangle());
    auto start = rest_of(cloth);
    for (Eigen::Vector3f& x : start) x *= 1.2f;
    for (const char* const method : one_by_one) {
        INFO(method);
        double side = 1.2;
        for (const double iterations : {1.0, 2.0, 3.0}) {
            side -= (side * side - 1.0) / (2.0 * side);
            const auto moved = projected(cloth, method, start, {{"iterations", iterations}});
            CHECK((moved[1] - moved[0]).norm() == Approx(side).margin(1e-6));
            CHECK((moved[2] - moved[1]).norm() == Approx(side).margin(1e-6));
        }
    }
}

TEST_CASE("ring_area: a lone triangle is the ring of each of its vertices", "[methods]") {
    const Cloth cloth = cloth_of(right_triangle());
    auto start = rest_of(cloth);
    start[2] = {0.3f, 1.7f, 0.4f};
    const auto ring = projected(cloth, "ring_area", start, {{"iterations", 1}});
    const auto triangle = projected(cloth, "pbd_area_gauss_seidel", start, {{"iterations", 3}});
    for (std::size_t v = 0; v < 3; ++v) CHECK((ring[v] - triangle[v]).norm() < 1e-6f);
}

TEST_CASE("pbd_area_jacobi: two triangles that pull the same way do not add up to an overshoot", "[methods]") {
    // Bases 0–1 and 1–2 on a line, vertex 3 above both: area 1 each at height 1, gradient (0, 1, 0).
    const Mesh pair{{{0, 1, 3}, {1, 2, 3}}, {-2, 0, 0, 0, 0, 0, 2, 0, 0, 0, 1, 0}};
    const Cloth cloth = cloth_of(pair, {0, 1, 2});
    auto start = rest_of(cloth);
    start[3].y() = 1.5f;
    const auto moved = projected(cloth, "pbd_area_jacobi", start, {{"iterations", 1}});
    CHECK((moved[3] - Eigen::Vector3f(0.0f, 1.0f, 0.0f)).norm() < 1e-6f);
}

TEST_CASE("Area: all orders of going through a stretched grid end with areas at rest", "[methods]") {
    const Cloth cloth = hanging_grid(5);
    const auto start = stretched(cloth, 1.2f);
    CHECK(greatest_area_change(cloth, start) > 0.15f);
    for (const char* const method : one_by_one) {
        INFO(method);
        CHECK(greatest_area_change(cloth, projected(cloth, method, start, {{"iterations", 20000}})) < 1e-3f);
    }
}

TEST_CASE("ring_area: the areas around each vertex add up to their rest areas", "[methods]") {
    const Cloth cloth = hanging_grid(5);
    const auto moved = projected(cloth, "ring_area", stretched(cloth, 1.2f), {{"iterations", 640}});
    const Topology& topology = *cloth.topology;
    for (std::size_t v = 0; v < topology.vertex_count(); ++v) {
        double now = 0.0, rest = 0.0;
        for (std::uint32_t c = topology.corner_offsets()[v]; c < topology.corner_offsets()[v + 1]; ++c) {
            now += area(topology.triangles()[topology.corners()[c] / 3], moved);
            rest += cloth.rest_areas[topology.corners()[c] / 3];
        }
        CHECK(now == Approx(rest).epsilon(1e-3));
    }
}

TEST_CASE("xpbd_area: compliance leaves alpha~ / (w |grad|^2 + alpha~) of an area change", "[methods]") {
    const Cloth cloth = cloth_of(right_triangle(), {0, 1});
    auto start = rest_of(cloth);
    start[2].y() = 1.5f;
    // alpha = 0.01 m^3/N and a step of 0.1 s: alpha~ = 1 m^2/kg = w |grad|^2. Half of the change stays, however often.
    for (const double iterations : {1.0, 10.0}) {
        const auto moved = projected(cloth, "xpbd_area", start, {{"iterations", iterations}, {"compliance", 0.01}});
        CHECK((moved[2] - Eigen::Vector3f(0.0f, 1.25f, 0.0f)).norm() < 1e-6f);
    }
}

TEST_CASE("xpbd_area: without compliance it is pbd_area_colored", "[methods]") {
    const Cloth cloth = hanging_grid(9);
    const auto start = stretched(cloth, 1.2f);
    for (const double iterations : {1.0, 7.0}) {
        const auto xpbd = projected(cloth, "xpbd_area", start, {{"iterations", iterations}});
        const auto pbd = projected(cloth, "pbd_area_colored", start, {{"iterations", iterations}});
        for (std::size_t v = 0; v < start.size(); ++v) CHECK((xpbd[v] - pbd[v]).norm() < 1e-5f);
    }
}
