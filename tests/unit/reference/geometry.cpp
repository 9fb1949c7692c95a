// SPDX-License-Identifier: MIT
#include "reference/geometry.hpp"

#include "unit/reference/sample_cloths.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::reference;
using Vector = Vector3<double>;

namespace {

TriangleGeometry<double> geometry_of(const std::vector<double>& positions) {
    return triangle_geometry<double>(Triangle{0, 1, 2}, positions);
}

}  // namespace

TEST_CASE("geometry of one right triangle, by hand") {
    const auto g = geometry_of(test::right_triangle().positions);
    CHECK(g.area == 1.0);
    CHECK(g.normal == Vector(0, 0, 1));
    // e_0 = (-2, 1, 0), e_1 = (0, -1, 0), e_2 = (2, 0, 0), turned by a quarter about z.
    CHECK(g.gradients[0] == Vector(-1, -2, 0));
    CHECK(g.gradients[1] == Vector(1, 0, 0));
    CHECK(g.gradients[2] == Vector(0, 2, 0));
}

TEST_CASE("half the corner gradient is the derivative of the area") {
    for (const auto& cloth : test::wavy_cloths()) {
        INFO(cloth.name);
        for (std::size_t a = 0; a < cloth.topology->triangle_count(); ++a) {
            const Triangle triangle = cloth.topology->triangles()[a];
            const auto g = triangle_geometry<double>(triangle, cloth.positions);
            for (std::size_t corner = 0; corner < 3; ++corner)
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    std::vector<double> positions = cloth.positions;
                    constexpr double h = 1e-6;  // central: the error is of order h² ~ 1e-12, rounding 1e-16 / h ~ 1e-10
                    double& coordinate = positions[3 * triangle[corner] + axis];
                    coordinate += h;
                    const double more = triangle_geometry<double>(triangle, positions).area;
                    coordinate -= 2 * h;
                    const double less = triangle_geometry<double>(triangle, positions).area;
                    CHECK(0.5 * g.gradients[corner][axis] == Approx((more - less) / (2 * h)).margin(1e-8));
                }
        }
    }
}

TEST_CASE("corner gradients are as long as the opposite edge, normal to it and in the triangle's plane") {
    for (const auto& cloth : test::wavy_cloths())
        for (const Triangle& triangle : cloth.topology->triangles()) {
            const auto g = triangle_geometry<double>(triangle, cloth.positions);
            CHECK(g.normal.norm() == Approx(1.0));
            for (std::size_t i = 0; i < 3; ++i) {
                const Vector edge = position<double>(cloth.positions, triangle[(i + 2) % 3]) -
                                    position<double>(cloth.positions, triangle[(i + 1) % 3]);
                CHECK(g.gradients[i].norm() == Approx(edge.norm()));
                CHECK(g.gradients[i].dot(edge) == Approx(0.0).margin(1e-12));
                CHECK(g.gradients[i].dot(g.normal) == Approx(0.0).margin(1e-12));
            }
            // Moving the whole triangle changes no area.
            CHECK((g.gradients[0] + g.gradients[1] + g.gradients[2]).norm() == Approx(0.0).margin(1e-12));
        }
}

TEST_CASE("a triangle without area has zero gradients and no NaN") {
    for (const std::vector<double>& positions :
         {std::vector<double>{1, 2, 3, 1, 2, 3, 1, 2, 3},               // a point
          std::vector<double>{0, 0, 0, 1, 1, 1, 2, 2, 2},               // a line
          std::vector<double>{0, 0, 0, 1e-200, 0, 0, 0, 1e-200, 0}}) {  // area below the smallest number
        const auto g = geometry_of(positions);
        CHECK(g.area == 0.0);
        CHECK(g.normal == Vector(0, 0, 0));
        for (const Vector& gradient : g.gradients) CHECK(gradient == Vector(0, 0, 0));
    }
    const std::vector<float> tiny{0, 0, 0, 1e-30f, 0, 0, 0, 1e-30f, 0};
    CHECK(triangle_geometry<float>(Triangle{0, 1, 2}, tiny).gradients[0] == Vector3<float>(0, 0, 0));
}

TEST_CASE("a needle keeps a unit normal and finite gradients") {
    const auto g = geometry_of({0, 0, 0, 1, 0, 0, 0.5, 1e-12, 0});
    CHECK(g.area == Approx(0.5e-12));
    CHECK(g.normal.norm() == Approx(1.0));
    CHECK(g.gradients[2].norm() == Approx(1.0));
}
