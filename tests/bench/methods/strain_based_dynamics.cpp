// SPDX-License-Identifier: MIT
//
// Against values by hand. The right triangle (0,0,0), (2,0,0), (0,1,0) has its warp along x, Q = diag(2, 1), so that
// f₁ = p₁ / 2 and f₂ = p₂.

#include "bench/methods/sample_cloths.hpp"

#include <Eigen/Geometry>

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;
using Eigen::Vector3f;
using methods::Cloth;

namespace {

const std::string strain = "strain_based_dynamics_strain";
const std::string area_method = "strain_based_dynamics_area";

}  // namespace

TEST_CASE("strain_based_dynamics_strain: one stretched thread comes to its length in one iteration", "[methods]") {
    const Cloth cloth = cloth_of(right_triangle(), {0, 2});
    auto start = rest_of(cloth);
    start[1].x() = 3.0f;
    const auto moved = projected(cloth, strain, start, {{"iterations", 1}});
    CHECK((moved[1] - Vector3f(2.0f, 0.0f, 0.0f)).norm() < 1e-6f);
}

TEST_CASE("strain_based_dynamics_strain: free ends share a correction by their inverse masses", "[methods]") {
    Cloth cloth = cloth_of(right_triangle(), {2});
    cloth.inverse_masses[1] = 3.0;
    const std::vector<Vector3f> start{{0.0f, 0.0f, 0.0f}, {3.0f, 0.0f, 0.0f}, {0.25f, 1.0f, 0.0f}};
    const auto moved = projected(cloth, strain, start, {{"iterations", 1}});
    CHECK((moved[0] - Vector3f(0.25f, 0.0f, 0.0f)).norm() < 1e-6f);
    CHECK((moved[1] - Vector3f(2.25f, 0.0f, 0.0f)).norm() < 1e-6f);
}

TEST_CASE("strain_based_dynamics_strain: shear turns a thread along its tangent", "[methods]") {
    // One of f₁, f₂ leans by θ, and C = sin θ has a gradient of cos θ across it: a step of tan θ, which ends on its
    // axis.
    const float lean = 0.6f;
    const Cloth weft = cloth_of(right_triangle(), {0, 1});
    auto start = rest_of(weft);
    start[2] = {std::sin(lean), std::cos(lean), 0.0f};
    auto moved = projected(weft, strain, start, {{"iterations", 1}});
    CHECK((moved[2] - Vector3f(0.0f, 1.0f / std::cos(lean), 0.0f)).norm() < 1e-6f);
    const Cloth warp = cloth_of(right_triangle(), {0, 2});
    start = rest_of(warp);
    start[1] = {2.0f * std::cos(lean), 2.0f * std::sin(lean), 0.0f};
    moved = projected(warp, strain, start, {{"iterations", 1}});
    CHECK((moved[1] - Vector3f(2.0f / std::cos(lean), 0.0f, 0.0f)).norm() < 1e-6f);
}

TEST_CASE("strain_based_dynamics_area: one iteration is a Newton step on the squared area", "[methods]") {
    // y² − 1 with y the height of corner 2: y − (y² − 1) / 2y; below a third the step is shortened by 9 y².
    const Cloth cloth = cloth_of(right_triangle(), {0, 1});
    auto start = rest_of(cloth);
    for (const auto& [height, wanted] : {std::pair{2.0f, 1.25f}, {0.5f, 1.25f}, {0.1f, 0.1f + 0.09f * 0.99f / 0.2f}}) {
        start[2].y() = height;
        const auto moved = projected(cloth, area_method, start, {{"iterations", 1}});
        CHECK((moved[2] - Vector3f(0.0f, wanted, 0.0f)).norm() < 1e-6f);
    }
}

TEST_CASE("strain_based_dynamics: momentum is conserved", "[methods]") {
    Cloth cloth = cloth_of(right_triangle());
    cloth.inverse_masses = {1.0, 3.0, 0.5};
    const std::vector<Vector3f> start{{0.1f, 0.0f, 0.3f}, {2.9f, -0.2f, 0.0f}, {0.4f, 1.2f, -0.3f}};
    for (const std::string& method : {strain, area_method}) {
        const auto moved = projected(cloth, method, start, {{"iterations", 1}});
        CHECK((moved[0] - start[0]).norm() > 1e-3f);
        CHECK((first_moment(cloth, moved) - first_moment(cloth, start)).norm() < 1e-6);
    }
    // One constraint alone keeps angular momentum, too.
    const auto moved = projected(cloth, area_method, start, {{"iterations", 1}});
    Vector3f turned = Vector3f::Zero();
    for (std::size_t v = 0; v < 3; ++v)
        turned += start[v].cross(moved[v] - start[v]) / static_cast<float>(cloth.inverse_masses[v]);
    CHECK(turned.norm() < 1e-5f);
}

TEST_CASE("strain_based_dynamics: enough iterations restore a stretched grid", "[methods]") {
    const Cloth cloth = hanging_grid(9);
    const auto start = stretched(cloth, 1.2f);
    REQUIRE(greatest_area_change(cloth, start) > 0.15f);
    const auto unstrained = projected(cloth, strain, start, {{"iterations", 640}});
    CHECK(greatest_edge_ratio(cloth, unstrained) < 1.01f);
    CHECK(least_edge_ratio(cloth, unstrained) > 0.99f);
    CHECK(greatest_area_change(cloth, projected(cloth, area_method, start, {{"iterations", 640}})) < 0.01f);
}
