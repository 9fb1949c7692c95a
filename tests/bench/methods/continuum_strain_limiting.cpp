// SPDX-License-Identifier: MIT
//
// The right triangle (0,0,0), (2,0,0), (0,1,0) with its warp along x.

#include "bench/methods/sample_cloths.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <catch2/catch.hpp>

using namespace apsl;
using namespace apsl::test;
using Eigen::Vector2f;
using Eigen::Vector3f;
using methods::Cloth;

namespace {

const std::string limiting = "continuum_strain_limiting";

/// Principal stretches of the moved right triangle.
Vector2f stretches(const std::vector<Vector3f>& positions) {
    Eigen::Matrix<float, 3, 2> gradient;
    gradient << (positions[1] - positions[0]) / 2.0f, positions[2] - positions[0];
    return Eigen::JacobiSVD<Eigen::Matrix<float, 3, 2>>(gradient).singularValues();
}

}  // namespace

TEST_CASE("continuum_strain_limiting: one triangle between two pins is cut to the limit at once", "[methods]") {
    const Cloth cloth = cloth_of(right_triangle(), {0, 2});
    auto start = rest_of(cloth);
    start[1].x() = 3.0f;
    const auto moved = projected(cloth, limiting, start, {{"iterations", 1}, {"limit", 0.25}});
    CHECK((moved[1] - Vector3f(2.5f, 0.0f, 0.0f)).norm() < 1e-6f);
    start[1].x() = 2.4f;
    CHECK(same_bytes(projected(cloth, limiting, start, {{"limit", 0.25}}), start));
}

TEST_CASE("continuum_strain_limiting: a free triangle of any shape keeps within the limit, and both momenta",
          "[methods]") {
    Cloth cloth = cloth_of(right_triangle());
    cloth.inverse_masses = {1.0, 3.0, 0.5};
    const std::vector<Vector3f> start{{0.1f, 0.0f, 0.3f}, {2.9f, -0.9f, 0.0f}, {1.4f, 0.5f, -0.3f}};
    REQUIRE(stretches(start)[0] > 1.2f);
    REQUIRE(stretches(start)[1] < 0.8f);
    const auto moved = projected(cloth, limiting, start, {{"iterations", 1}, {"limit", 0.1}});
    CHECK(stretches(moved)[0] == Approx(1.1f).margin(1e-5));
    CHECK(stretches(moved)[1] == Approx(0.9f).margin(1e-5));
    CHECK((first_moment(cloth, moved) - first_moment(cloth, start)).norm() < 1e-5);
    Vector3f turned = Vector3f::Zero();
    for (std::size_t v = 0; v < 3; ++v)
        turned += start[v].cross(moved[v] - start[v]) / static_cast<float>(cloth.inverse_masses[v]);
    CHECK(turned.norm() < 1e-5f);
}

TEST_CASE("continuum_strain_limiting: one pinned corner is what the triangle turns about", "[methods]") {
    const Cloth cloth = cloth_of(right_triangle(), {1});
    const std::vector<Vector3f> start{{0.1f, 0.0f, 0.3f}, {2.9f, -0.9f, 0.0f}, {1.4f, 0.5f, -0.3f}};
    const auto moved = projected(cloth, limiting, start, {{"iterations", 1}, {"limit", 0.0}});
    CHECK((stretches(moved) - Vector2f(1.0f, 1.0f)).norm() < 1e-5f);
    Vector3f turned = Vector3f::Zero();
    for (const std::size_t v : {0u, 2u}) turned += (start[v] - start[1]).cross(moved[v] - start[v]);
    CHECK(turned.norm() < 1e-5f);
}

TEST_CASE("continuum_strain_limiting: enough iterations hold a stretched grid within the limit", "[methods]") {
    const Cloth cloth = hanging_grid(9);
    const auto moved = projected(cloth, limiting, stretched(cloth, 1.2f), {{"iterations", 640}, {"limit", 0.02}});
    CHECK(greatest_edge_ratio(cloth, moved) < 1.025f);
    CHECK(least_edge_ratio(cloth, moved) > 0.975f);
}
