// SPDX-License-Identifier: MIT
#include "reference/stretch_rows.hpp"

#include "reference/chebyshev.hpp"
#include "unit/reference/sample_cloths.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

using namespace apsl;
using namespace apsl::reference;
using Vector = Vector3<double>;

namespace {

constexpr Triangle one{0, 1, 2};
constexpr double ceiling = 1.1;

/// Rest shapes of a cloth whose rest positions are what `positions` holds, drawn out and sheared.
std::vector<RestShape<double>> deformed_rest_shapes(const test::SampleCloth& cloth) {
    std::vector<double> rest = cloth.positions;
    for (std::size_t n = 0; n < rest.size(); n += 3) {
        rest[n] *= 0.8;
        rest[n + 1] += 0.3 * rest[n];
    }
    std::vector<RestShape<double>> shapes;
    for (const Triangle& triangle : cloth.topology->triangles()) shapes.push_back(rest_shape<double>(triangle, rest));
    return shapes;
}

std::array<double, 3> corner_masses(const test::SampleCloth& cloth, std::size_t a) {
    const Triangle& t = cloth.topology->triangles()[a];
    return {cloth.inverse_masses[t[0]], cloth.inverse_masses[t[1]], cloth.inverse_masses[t[2]]};
}

double weighted(const ConstraintRow<double>& a, const ConstraintRow<double>& b, const std::array<double, 3>& w) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k) sum += w[k] * a.gradients[k].dot(b.gradients[k]);
    return sum;
}

/// The area rows of a cloth, then its stretch rows, as they are or orthogonalized.
RowSystem<double> both_kinds(const test::SampleCloth& cloth, bool orthogonal) {
    const std::vector<RestShape<double>> shapes = deformed_rest_shapes(cloth);
    const std::size_t count = shapes.size();
    std::vector<ConstraintRow<double>> rows(2 * count);
    std::vector<std::uint32_t> owners(2 * count);
    for (std::size_t a = 0; a < count; ++a) {
        const Triangle& triangle = cloth.topology->triangles()[a];
        owners[a] = owners[count + a] = static_cast<std::uint32_t>(a);
        rows[a] = area_row(cloth.geometry()[a], cloth.rest_areas[a]);
        rows[count + a] = stretch_row<double>(shapes[a], triangle, cloth.positions, cloth.rest_areas[a], ceiling);
        if (orthogonal) rows[count + a] = orthogonalized(rows[count + a], rows[a], corner_masses(cloth, a));
    }
    return row_system<double>(*cloth.topology, rows, owners, cloth.inverse_masses);
}

Eigen::VectorXd displacement(const RowSystem<double>& system, const test::SampleCloth& cloth,
                             const Eigen::VectorXd& y) {
    Eigen::VectorXd moved = -(system.J.transpose() * y);
    for (Eigen::Index n = 0; n < moved.size(); ++n) moved[n] *= cloth.inverse_masses[static_cast<std::size_t>(n / 3)];
    return moved;
}

/// A square of two triangles that nothing pins, hanging in space; areas off, and the first stretched beyond 1.1.
test::SampleCloth stretched_pair() {
    test::SampleCloth cloth;
    cloth.name = "stretched pair";
    cloth.topology = Topology::build(std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}, 4);
    cloth.positions = {0.0, 0.0, 0.0, 1.4, 0.1, 0.0, 0.0, 0.9, 0.1, 1.1, 1.0, -0.1};
    cloth.inverse_masses = {1.0, 2.0, 1.5, 0.5};
    cloth.rest_areas = {0.5, 0.5};
    return cloth;
}

}  // namespace

TEST_CASE("rest shape: shape functions of a right triangle, by hand; none without area", "[stretch_rows]") {
    const RestShape<double> shape = rest_shape<double>(one, test::right_triangle().positions);  // 2 m by 1 m
    CHECK(shape[0] == Vector2<double>(-0.5, -1.0));
    CHECK(shape[1] == Vector2<double>(0.5, 0.0));
    CHECK(shape[2] == Vector2<double>(0.0, 1.0));
    for (const std::vector<double>& flat :
         {std::vector<double>{0, 0, 0, 1, 0, 0, 2, 0, 0}, std::vector<double>{1, 1, 1, 1, 1, 1, 1, 1, 1}})
        for (const Vector2<double>& gradient : rest_shape<double>(one, flat))
            CHECK(gradient == Vector2<double>(0.0, 0.0));
}

TEST_CASE("principal stretch: drawn, squeezed, sheared and turned, by hand", "[stretch_rows]") {
    const RestShape<double> shape = rest_shape<double>(one, test::right_triangle().positions);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vector(1, 2, 3).normalized()).toRotationMatrix();
    const auto of = [&](const Eigen::Matrix2d& F) {
        std::vector<double> positions;
        for (const Eigen::Vector2d& corner : {Eigen::Vector2d(0, 0), Eigen::Vector2d(2, 0), Eigen::Vector2d(0, 1)}) {
            const Eigen::Vector2d flat = F * corner;
            const Vector placed = turn * Vector(flat[0], flat[1], 0.0) + Vector(3, -2, 1);
            positions.insert(positions.end(), placed.data(), placed.data() + 3);
        }
        const PrincipalStretch<double> stretch = principal_stretch<double>(shape, one, positions);
        CHECK(std::abs(stretch.material.norm() - 1.0) < 1e-14);
        const Eigen::Vector2d drawn = F * stretch.material;
        CHECK((turn * Vector(drawn[0], drawn[1], 0.0) - stretch.value * stretch.spatial).norm() < 1e-13);
        return stretch.value;
    };
    CHECK(of(Eigen::Matrix2d::Identity()) == Approx(1.0).epsilon(1e-14));
    CHECK(of(Eigen::Vector2d(1.3, 0.8).asDiagonal()) == Approx(1.3).epsilon(1e-14));
    CHECK(of(Eigen::Vector2d(0.8, 1.3).asDiagonal()) == Approx(1.3).epsilon(1e-14));
    for (const double shear : {0.5, -0.5}) {
        Eigen::Matrix2d F;
        F << 1.0, shear, 0.0, 1.0;
        CHECK(of(F) == Approx(0.5 * (0.5 + std::sqrt(4.25))).epsilon(1e-14));
    }
    CHECK(of(Eigen::Matrix2d::Zero()) == 0.0);
}

TEST_CASE("stretch row: its gradients are the derivatives of its value; no force, no torque", "[stretch_rows]") {
    for (const test::SampleCloth& cloth : test::wavy_cloths()) {
        CAPTURE(cloth.name);
        const std::vector<RestShape<double>> shapes = deformed_rest_shapes(cloth);
        for (std::size_t a = 0; a < shapes.size(); ++a) {
            const Triangle& triangle = cloth.topology->triangles()[a];
            const double rest_area = cloth.rest_areas[a];
            const auto row_at = [&](const std::vector<double>& positions) {
                return stretch_row<double>(shapes[a], triangle, positions, rest_area, ceiling);
            };
            const ConstraintRow<double> row = row_at(cloth.positions);
            Vector force = Vector::Zero(), torque = Vector::Zero();
            double size = 0.0;
            for (std::size_t k = 0; k < 3; ++k) {
                force += row.gradients[k];
                torque += position<double>(cloth.positions, triangle[k]).cross(row.gradients[k]);
                size += row.gradients[k].norm();
            }
            CHECK(force.norm() <= 1e-13 * size);
            CHECK(torque.norm() <= 1e-12 * size * (1.0 + position<double>(cloth.positions, triangle[0]).norm()));
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const double step = 1e-6 * std::sqrt(rest_area);
                    std::vector<double> positions = cloth.positions;
                    double& moved = positions[3 * triangle[k] + axis];
                    const double before = moved;
                    moved = before + step;
                    const double above = row_at(positions).value;
                    moved = before - step;
                    const double below = row_at(positions).value;
                    CHECK(std::abs((above - below) / (2.0 * step) - row.gradients[k][static_cast<int>(axis)]) <=
                          1e-5 * size);
                }
        }
    }
}

TEST_CASE("orthogonalized row: at right angles to the area row, and an exact change of variables", "[stretch_rows]") {
    for (const test::SampleCloth& cloth : test::wavy_cloths()) {
        CAPTURE(cloth.name);
        const std::vector<RestShape<double>> shapes = deformed_rest_shapes(cloth);
        for (std::size_t a = 0; a < shapes.size(); ++a) {
            const ConstraintRow<double> area = area_row(cloth.geometry()[a], cloth.rest_areas[a]);
            const ConstraintRow<double> stretch = stretch_row<double>(shapes[a], cloth.topology->triangles()[a],
                                                                      cloth.positions, cloth.rest_areas[a], ceiling);
            const std::array<double, 3> w = corner_masses(cloth, a);
            const ConstraintRow<double> beyond = orthogonalized(stretch, area, w);
            CHECK(std::abs(weighted(beyond, area, w)) <=
                  1e-12 * std::sqrt(weighted(stretch, stretch, w) * weighted(area, area, w)));
        }
    }

    const test::SampleCloth cloth = stretched_pair();
    const RowSystem<double> skewed = both_kinds(cloth, false), orthogonal = both_kinds(cloth, true);
    const auto solve = [&](const RowSystem<double>& system) -> Eigen::VectorXd {
        const Eigen::MatrixXd G = row_matrix<double>(system, cloth.inverse_masses);
        return G.fullPivHouseholderQr().solve(system.b);
    };
    const Eigen::VectorXd y = solve(skewed), z = solve(orthogonal);
    CHECK((displacement(skewed, cloth, y) - displacement(orthogonal, cloth, z)).norm() <
          1e-10 * displacement(skewed, cloth, y).norm());
    for (Eigen::Index r = 2; r < 4; ++r)
        CHECK(y[r] / skewed.scale[r] == Approx(z[r] / orthogonal.scale[r]).epsilon(1e-9));
    CHECK(std::abs(y[2]) > 1e-3);
}

TEST_CASE("orthogonalized row: a weak one is asked for less of what it demands, never for less slack",
          "[stretch_rows]") {
    CHECK(asked_of_row(0.3, 0.5, 1.0) == 0.3);
    CHECK(asked_of_row(0.3, 0.2, 2.0) == Approx(0.3));  // a tenth: the least that is not weak
    CHECK(asked_of_row(0.3, 0.1, 2.0) == Approx(0.075));
    CHECK(asked_of_row(0.3, 0.02, 2.0) == Approx(0.003));
    CHECK(asked_of_row(0.3, 0.0, 2.0) == 0.0);
    CHECK(asked_of_row(-0.3, 0.02, 2.0) == -0.3);
}

TEST_CASE("orthogonalized row: what a pinned corner cannot give makes it weak", "[stretch_rows]") {
    ConstraintRow<double> row{1.0, {Eigen::Vector3d(3, 0, 0), Eigen::Vector3d(0, -4, 0), Eigen::Vector3d(0, 0, 1)}};
    CHECK(movable_share<double>(row, {1, 1, 1}) == 1.0);
    CHECK(movable_share<double>(row, {2, 1e-6, 5}) == 1.0);  // however heavy
    CHECK(movable_share<double>(row, {0, 1, 1}) == Approx(17.0 / 26));
    CHECK(movable_share<double>(row, {0, 0, 1}) == Approx(1.0 / 26));
    CHECK(movable_share<double>(row, {0, 0, 0}) == 0.0);
    for (Eigen::Vector3d& gradient : row.gradients) gradient.setZero();
    CHECK(movable_share<double>(row, {1, 1, 1}) == 0.0);
}

TEST_CASE("area row: pins near to one another make it weak, in both directions", "[stretch_rows]") {
    ConstraintRow<double> row{0.7,
                              {Eigen::Vector3d(0.1, 0, 0), Eigen::Vector3d(0, 0.2, 0), Eigen::Vector3d(0.1, -0.2, 0)}};
    CHECK(asked_of_area_row<double>(row, 0.08, {1, 1, 1}) == 0.7);
    CHECK(asked_of_area_row<double>(row, 0.08, {1, 0, 0}) == 0.7);                // Σ = 0.01 > 0.1 · 0.08
    CHECK(asked_of_area_row<double>(row, 0.2, {1, 0, 0}) == Approx(0.7 * 0.25));  // 0.01 of 0.02
    CHECK(asked_of_area_row<double>(row, 1.0, {1, 0, 0}) == Approx(0.7 * 0.01));  // 0.01 of 0.1
    CHECK(asked_of_area_row<double>(row, 1.0, {1, 5, 0}) == Approx(0.7 * 0.25));  // 0.05 of 0.1
    CHECK(asked_of_area_row<double>(row, 1.0, {1e-6, 5, 1}) == 0.7);              // however heavy
    CHECK(asked_of_area_row<double>(row, 1.0, {0, 0, 0}) == 0.0);
    CHECK(asked_of_area_row<double>(row, 0.0, {1, 0, 0}) == 0.7);
    row.value = -0.7;
    CHECK(asked_of_area_row<double>(row, 1.0, {1, 0, 0}) == Approx(-0.7 * 0.01));
}

TEST_CASE("row system: ones on the diagonal, and no eigenvalue above the bound", "[stretch_rows]") {
    for (const test::SampleCloth& cloth : test::wavy_cloths()) {
        CAPTURE(cloth.name);
        const RowSystem<double> system = both_kinds(cloth, true);
        const Eigen::MatrixXd G = row_matrix<double>(system, cloth.inverse_masses);
        for (Eigen::Index r = 0; r < G.rows(); ++r)
            CHECK(G(r, r) == Approx(system.scale[r] > 0.0 ? 1.0 : 0.0).epsilon(1e-12));
        const TriangleVector<double> bound = row_bound<double>(system, cloth.inverse_masses);
        const TriangleVector<double> inverse = (bound.array() > 0.0).select(bound.cwiseSqrt().cwiseInverse(), 0.0);
        const Eigen::MatrixXd scaled = inverse.asDiagonal() * G * inverse.asDiagonal();
        const double greatest =
            Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
        CHECK(greatest <= 1.0 + 1e-12);
        CHECK(greatest > 0.2);
    }
}

TEST_CASE("clamped Chebyshev: no multiplier below 0, and repeated it solves the complementarity problem",
          "[stretch_rows][chebyshev]") {
    test::SampleCloth pair = stretched_pair();
    std::size_t at_work = 0, at_rest = 0;
    // Scales of the whole pair: every row at work, some, none.
    for (const double scale : {1.2, 1.0, 0.95, 0.8, 0.5}) {
        CAPTURE(scale);
        test::SampleCloth cloth = pair;
        for (double& x : cloth.positions) x *= scale;
        // Rest shapes of the pair itself: the principal stretch is `scale` times that of the shapes.
        const std::vector<RestShape<double>> shapes = deformed_rest_shapes(pair);
        std::vector<ConstraintRow<double>> rows;
        for (std::size_t a = 0; a < 2; ++a) rows.push_back(area_row(cloth.geometry()[a], cloth.rest_areas[a]));
        for (std::size_t a = 0; a < 2; ++a)
            rows.push_back(orthogonalized(stretch_row<double>(shapes[a], cloth.topology->triangles()[a],
                                                              cloth.positions, cloth.rest_areas[a], ceiling),
                                          rows[a], corner_masses(cloth, a)));
        const std::vector<std::uint32_t> owners{0, 1, 0, 1};
        const std::vector<std::uint8_t> one_sided{0, 0, 1, 1};
        const RowSystem<double> system = row_system<double>(*cloth.topology, rows, owners, cloth.inverse_masses);
        const SparseMatrix<double> G = row_matrix<double>(system, cloth.inverse_masses);
        const TriangleVector<double> bound = row_bound<double>(system, cloth.inverse_masses);
        ChebyshevScratch<double> scratch;
        TriangleVector<double> y;
        for (const int products : {0, 1, 5}) {
            chebyshev<double>(G, bound, system.b, products, scratch, y, one_sided);
            CHECK(y.tail(2).minCoeff() >= 0.0);
        }
        for (int solve = 0; solve < 2000; ++solve)
            chebyshev<double>(G, bound, system.b, 10, scratch, y, one_sided, true);
        CHECK(y.tail(2).minCoeff() >= 0.0);
        const TriangleVector<double> left = G * y - system.b;
        const double small = 1e-6 * system.b.norm();
        CHECK(left.head(2).norm() <= small);
        CHECK(left.tail(2).minCoeff() >= -small);
        for (Eigen::Index r = 2; r < 4; ++r) {
            CHECK(std::abs(y[r] * left[r]) <= small * std::max(1.0, y[r]));
            ++(y[r] > 0.0 ? at_work : at_rest);
        }
    }
    CHECK(at_work >= 2);
    CHECK(at_rest >= 2);
}

TEST_CASE("area and stretch rows together: steps with many products end at the rest area and at or below the ceiling",
          "[stretch_rows]") {
    const std::vector<double> rest = test::right_triangle().positions;
    const RestShape<double> shape = rest_shape<double>(one, rest);
    test::SampleCloth cloth;
    cloth.topology = Topology::build(std::vector<Triangle>{one}, 3);
    cloth.inverse_masses = {1.0, 3.0, 0.5};
    cloth.rest_areas = {1.0};
    cloth.positions = {0.0, 0.0, 0.0, 3.0, 0.4, 0.2, 0.1, 0.5, 0.0};
    const std::vector<std::uint32_t> owners{0, 0};
    const std::vector<std::uint8_t> one_sided{0, 1};
    CHECK(principal_stretch<double>(shape, one, cloth.positions).value > 1.4);
    for (int step = 0; step < 20; ++step) {
        const ConstraintRow<double> area = area_row(cloth.geometry()[0], 1.0);
        const std::vector<ConstraintRow<double>> rows{
            area, orthogonalized(stretch_row<double>(shape, one, cloth.positions, 1.0, ceiling), area,
                                 corner_masses(cloth, 0))};
        const RowSystem<double> system = row_system<double>(*cloth.topology, rows, owners, cloth.inverse_masses);
        ChebyshevScratch<double> scratch;
        TriangleVector<double> y;
        chebyshev<double>(row_matrix<double>(system, cloth.inverse_masses),
                          row_bound<double>(system, cloth.inverse_masses), system.b, 50, scratch, y, one_sided);
        const Eigen::VectorXd moved = displacement(system, cloth, y);
        for (std::size_t n = 0; n < 9; ++n) cloth.positions[n] += moved[static_cast<Eigen::Index>(n)];
    }
    CHECK(cloth.geometry()[0].area == Approx(1.0).epsilon(1e-9));
    const double stretch = principal_stretch<double>(shape, one, cloth.positions).value;
    CHECK(stretch <= ceiling + 1e-9);
    CHECK(stretch > 1.0);
}
