// SPDX-License-Identifier: MIT
#include "reference/hinges.hpp"

#include "unit/reference/sample_cloths.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace apsl;
using namespace apsl::reference;
using Vector = Vector3<double>;

namespace {

constexpr double pi = std::numbers::pi;
constexpr Hinge one{0, 1, 2, 3};

// An edge of 2 m along y; triangles of heights 1 m towards +x and 3 m, turned about the edge by `angle` out of −x
// towards +z. Their corners lie at 1/2 and at 1/4 of the edge.
std::vector<double> folded(double angle) {
    return {0, 0, 0, 0, 2, 0, 1, 1, 0, -3 * std::cos(angle), 0.5, 3 * std::sin(angle)};
}

double angle_at(std::span<const double> positions) {
    return hinge_geometry<double>(one, positions).angle;
}

void check_equal(const Vector& got, const Vector& want) {
    CHECK((got - want).norm() == Approx(0.0).margin(1e-12));
}

}  // namespace

TEST_CASE("a flat hinge: gradients by hand", "[hinges]") {
    const HingeGeometry<double> flat = hinge_geometry<double>(one, folded(0.0));
    CHECK(flat.angle == 0.0);
    check_equal(flat.gradients[0], {0, 0, -0.75});
    check_equal(flat.gradients[1], {0, 0, -7.0 / 12.0});
    check_equal(flat.gradients[2], {0, 0, 1});  // over its height
    check_equal(flat.gradients[3], {0, 0, 1.0 / 3.0});
}

TEST_CASE("the angle of a hinge is that which it is folded by", "[hinges]") {
    for (const double angle : {-3.1, -pi / 2, -0.3, -1e-9, 1e-9, 0.7, pi / 2, 3.1}) {
        CAPTURE(angle);
        CHECK(angle_at(folded(angle)) == Approx(angle).epsilon(1e-12));
    }
    // The order of the vertices gives the sign.
    CHECK(hinge_geometry<double>({1, 0, 2, 3}, folded(0.7)).angle == Approx(-0.7));
    CHECK(hinge_geometry<double>({0, 1, 3, 2}, folded(0.7)).angle == Approx(-0.7));
}

TEST_CASE("gradients of hinges are finite differences of their angles", "[hinges]") {
    for (const test::SampleCloth& cloth : test::wavy_cloths()) {
        INFO(cloth.name);
        for (const Hinge& hinge : cloth.topology->hinges()) {
            const HingeGeometry<double> g = hinge_geometry<double>(hinge, cloth.positions);
            if (std::abs(g.angle) > 3.0) continue;  // the angle jumps at ±π
            double scale = 0.0;
            for (const Vector& gradient : g.gradients) scale = std::max(scale, gradient.norm());
            std::vector<double> moved = cloth.positions;
            for (std::size_t k = 0; k < 4; ++k)
                for (int axis = 0; axis < 3; ++axis) {
                    double& x = moved[3 * hinge[k] + static_cast<std::size_t>(axis)];
                    const double at = x, step = 1e-4 / scale;
                    x = at + step;
                    const double above = hinge_geometry<double>(hinge, moved).angle;
                    x = at - step;
                    const double below = hinge_geometry<double>(hinge, moved).angle;
                    x = at;
                    CHECK((above - below) / (2 * step) == Approx(g.gradients[k][axis]).margin(1e-5 * scale));
                }
        }
    }
}

TEST_CASE("a hinge neither pushes nor turns what it belongs to", "[hinges]") {
    for (const test::SampleCloth& cloth : test::wavy_cloths())
        for (const Hinge& hinge : cloth.topology->hinges()) {
            const HingeGeometry<double> g = hinge_geometry<double>(hinge, cloth.positions);
            Vector force = Vector::Zero(), torque = Vector::Zero();
            double scale = 0.0;
            for (std::size_t k = 0; k < 4; ++k) {
                const Vector x = position<double>(cloth.positions, hinge[k]);
                force += g.gradients[k];
                torque += x.cross(g.gradients[k]);
                scale += (1.0 + x.norm()) * g.gradients[k].norm();
            }
            CHECK(force.norm() <= 1e-12 * scale);
            CHECK(torque.norm() <= 1e-12 * scale);
        }
}

TEST_CASE("a hinge at rest: its angle, and its edge squared over its areas", "[hinges]") {
    const RestHinge<double> rest = rest_hinge<double>(one, folded(0.7));
    CHECK(rest.angle == Approx(0.7));
    CHECK(rest.shape == Approx(4.0 / (1.0 + 3.0)));
    CHECK(hinge_energy(rest, 0.5, 0.7) == 0.0);
    CHECK(hinge_energy(rest, 0.5, 0.9) == Approx(0.5 * 0.5 * 0.04));
    // From just below π to just above −π it is a small bend, not a whole turn.
    CHECK(bend(-3.1, 3.1) == Approx(2 * pi - 6.2));
    CHECK(bend(3.1, -3.1) == Approx(6.2 - 2 * pi));
}

TEST_CASE("a hinge with a triangle of no area has no angle, and at rest bends freely", "[hinges]") {
    std::vector<double> positions = folded(0.7);
    for (std::size_t axis = 0; axis < 3; ++axis) positions[6 + axis] = axis == 1 ? 1.5 : 0.0;  // onto the edge
    const HingeGeometry<double> g = hinge_geometry<double>(one, positions);
    CHECK(g.angle == 0.0);
    for (const Vector& gradient : g.gradients) CHECK(gradient.norm() == 0.0);
    CHECK(rest_hinge<double>(one, positions).shape == 0.0);
    CHECK(hinge_energy(rest_hinge<double>(one, positions), 1.0, 1.0) == 0.0);
}

TEST_CASE("a sheet bent to a cylinder has the energy of a plate, along its grid", "[hinges]") {
    // ½ B κ² for each square metre; the outermost half cells have no hinge. A facet is flat across its diagonal,
    // so the way of the diagonals does not matter.
    constexpr std::uint32_t columns = 17, rows = 5;
    constexpr double rigidity = 0.02, curvature = 1.5, width = 1.0 / (columns - 1);
    for (const auto diagonals : {test::Diagonals::uniform, test::Diagonals::alternating}) {
        const test::SampleCloth cloth = test::grid_cloth(columns, rows, diagonals);
        std::vector<double> bent = cloth.positions;
        for (std::size_t n = 0; n < bent.size(); n += 3) {
            // Chords of one cell's width.
            const double turned = curvature * bent[n], radius = width / (2 * std::sin(curvature * width / 2));
            bent[n] = radius * std::sin(turned);
            bent[n + 1] = radius * (1 - std::cos(turned));
        }
        double energy = 0.0, area = 0.0;
        for (const double a : cloth.rest_areas) area += a;
        for (const Hinge& hinge : cloth.topology->hinges())
            energy += hinge_energy(rest_hinge<double>(hinge, cloth.positions), rigidity,
                                   hinge_geometry<double>(hinge, bent).angle);
        CHECK(energy == Approx(0.5 * rigidity * curvature * curvature * area * (columns - 2) / (columns - 1)));
    }
}
