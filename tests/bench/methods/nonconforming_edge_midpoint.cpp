// SPDX-License-Identifier: MIT

#include "bench/methods/sample_cloths.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;
using Eigen::Vector3f;
using methods::Cloth;

namespace {

const std::string midpoints = "nonconforming_edge_midpoint";

/// 0.2 kg/m² lumped to the vertices, none pinned.
Cloth lumped(const Mesh& mesh) {
    Cloth cloth = cloth_of(mesh);
    std::vector<double> masses(mesh.vertex_count());
    for (std::size_t a = 0; a < mesh.triangles.size(); ++a)
        for (const std::uint32_t v : mesh.triangles[a]) masses[v] += 0.2 * cloth.rest_areas[a] / 3.0;
    for (std::size_t v = 0; v < masses.size(); ++v) cloth.inverse_masses[v] = 1.0 / masses[v];
    return cloth;
}

}  // namespace

TEST_CASE("nonconforming_edge_midpoint: one constraint by hand", "[methods]") {
    // A needle along x: corners 1 and 2 lie together at 1, pulled to 2. Midpoints m₀ = 2 (between them), m₁ = m₂ = 1.
    // In turn: m₁–m₂ have no direction; m₂–m₀ and m₀–m₁ want 1/2. Equal masses: the first gives m₂ = 1.25, m₀ = 1.75;
    // the second, 0.75 long, m₀ = 1.625, m₁ = 1.125. Corners: x₀ = Δ(m₁ + m₂ − m₀), x₁ = 2 + Δ(m₂ + m₀ − m₁) and so on.
    const Cloth cloth = cloth_of({{{0, 1, 2}}, {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1e-7, 0.0}});
    std::vector<Vector3f> start{{0.0f, 0.0f, 0.0f}, {2.0f, 0.0f, 0.0f}, {2.0f, 0.0f, 0.0f}};
    const auto moved = projected(cloth, midpoints, start, {{"iterations", 1}, {"passes", 1}});
    CHECK(moved[0].x() == Approx(0.75f).margin(1e-6));
    CHECK(moved[1].x() == Approx(1.75f).margin(1e-6));
    CHECK(moved[2].x() == Approx(1.5f).margin(1e-6));
}

TEST_CASE("nonconforming_edge_midpoint: a triangle between midpoints at rest is a triangle at rest", "[methods]") {
    const Cloth cloth = cloth_of(right_triangle());
    const std::vector<Vector3f> start{{0.1f, 0.0f, 0.3f}, {2.9f, -0.2f, 0.0f}, {0.4f, 1.2f, -0.3f}};
    const auto moved = projected(cloth, midpoints, start, {{"iterations", 100}, {"passes", 1}});
    CHECK(greatest_edge_ratio(cloth, moved) < 1.0001f);
    CHECK(least_edge_ratio(cloth, moved) > 0.9999f);
}

TEST_CASE("nonconforming_edge_midpoint: pinned corners hold what hangs on them", "[methods]") {
    const Cloth cloth = cloth_of(right_triangle(), {0, 2});
    auto start = rest_of(cloth);
    start[1].x() = 3.0f;
    const auto moved = projected(cloth, midpoints, start, {{"iterations", 100}, {"passes", 20}});
    CHECK((moved[1] - Vector3f(2.0f, 0.0f, 0.0f)).norm() < 1e-3f);
}

TEST_CASE("nonconforming_edge_midpoint: momentum is conserved where masses are lumped by area", "[methods]") {
    const Cloth cloth = lumped(grid(9, 7, 1.0, 0.8, Diagonals::random));
    const auto start = stretched(cloth, 1.2f);
    const auto moved = projected(cloth, midpoints, start);
    CHECK((moved[0] - start[0]).norm() > 1e-3f);
    const double mass = 0.2 * 0.8;
    CHECK((first_moment(cloth, moved) - first_moment(cloth, start)).norm() < 1e-6 * mass);
}

TEST_CASE("nonconforming_edge_midpoint: enough passes restore a stretched grid", "[methods]") {
    const Cloth cloth = hanging_grid(9);
    const auto moved = projected(cloth, midpoints, stretched(cloth, 1.2f), {{"iterations", 320}, {"passes", 40}});
    CHECK(greatest_edge_ratio(cloth, moved) < 1.02f);
    CHECK(least_edge_ratio(cloth, moved) > 0.98f);
}
