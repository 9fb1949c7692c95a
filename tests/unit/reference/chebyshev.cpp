// SPDX-License-Identifier: MIT
#include "reference/chebyshev.hpp"

#include "chebyshev_products.hpp"
#include "unit/reference/sample_cloths.hpp"

#include <apsl/error.hpp>
#include <apsl/reference.hpp>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::reference;

namespace {

/// The greatest eigenvalue of B^(−1/2) G B^(−1/2), rows without a bound left out.
double greatest_eigenvalue(const SparseMatrix<double>& G, const TriangleVector<double>& bound) {
    const TriangleVector<double> inverse = (bound.array() > 0.0).select(bound.cwiseSqrt().cwiseInverse(), 0.0);
    const Eigen::MatrixXd scaled = inverse.asDiagonal() * Eigen::MatrixXd(G) * inverse.asDiagonal();
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

struct Bounded {
    SparseMatrix<double> G;
    TriangleVector<double> bound;
};

Bounded bounded(const test::SampleCloth& cloth) {
    const auto geometry = cloth.geometry();
    Bounded result{pressure_matrix<double>(Matrix::consistent, *cloth.topology, geometry, cloth.inverse_masses), {}};
    std::vector<double> bounds;
    vertex_bounds<double>(*cloth.topology, geometry, bounds);
    diagonal_bound<double>(*cloth.topology, geometry, cloth.inverse_masses, bounds, result.bound);
    return result;
}

/// 1 − x q(x) at x: what a solve leaves of an error in a mode of eigenvalue x.
double left_of_error(double x, int products) {
    SparseMatrix<double> G(1, 1);
    G.insert(0, 0) = x;
    ChebyshevScratch<double> scratch;
    TriangleVector<double> lambda;
    const TriangleVector<double> one = TriangleVector<double>::Ones(1);
    chebyshev<double>(G, one, one, products, scratch, lambda);
    return 1.0 - x * lambda[0];
}

}  // namespace

TEST_CASE("diagonal bound: no eigenvalue of the scaled matrix above 1, on any mesh, and not far below it",
          "[reference]") {
    for (const test::SampleCloth& cloth : test::wavy_cloths()) {
        CAPTURE(cloth.name);
        const Bounded b = bounded(cloth);
        CHECK(b.bound.allFinite());
        const double greatest = greatest_eigenvalue(b.G, b.bound);
        CHECK(greatest <= 1.0 + 1e-12);
        if (b.bound.maxCoeff() > 0.0) CHECK(greatest >= 0.5);
    }
}

TEST_CASE("diagonal bound: also of cloth torn into needles", "[reference]") {
    for (const test::Diagonals diagonals : {test::Diagonals::alternating, test::Diagonals::uniform}) {
        test::SampleCloth cloth = test::grid_cloth(13, 13, diagonals);
        for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
            const auto x = static_cast<double>(v);
            cloth.positions[3 * v] *= 1.0 + 30.0 * std::abs(std::sin(1.3 * x));
            cloth.positions[3 * v + 2] += 0.3 * std::sin(2.1 * x);
            cloth.inverse_masses[v] *= std::pow(10.0, 2.0 * std::sin(0.7 * x));
        }
        const Bounded b = bounded(cloth);
        CHECK(greatest_eigenvalue(b.G, b.bound) <= 1.0 + 1e-12);
    }
}

TEST_CASE("diagonal bound: by hand", "[reference]") {
    // One triangle: ½ w g gᵀ has the eigenvalue ½ w |g|², so that the bound is the diagonal itself.
    const test::Mesh mesh = test::right_triangle();
    test::SampleCloth cloth{
        "triangle", Topology::build(mesh.triangles, mesh.vertex_count()), mesh.positions, {1.0, 2.0, 0.0}, {}};
    const Bounded one = bounded(cloth);
    CHECK(one.bound[0] == Approx(one.G.coeff(0, 0)));
    // Flat alternating grid, h = 1, unit inverse masses: around a vertex of eight triangles four directions of two g
    // each of length h, Σ g gᵀ = 4 h² I; around one of four triangles the g are of length √2 h, Σ g gᵀ = 4 h² I too.
    // B = ½ (4 + 4 + 4) h² = 6 h², with two equal eigenvalues times 2^(1/32).
    cloth = test::grid_cloth(9, 9, test::Diagonals::alternating);
    for (double& x : cloth.positions) x *= 8.0;
    std::fill(cloth.inverse_masses.begin(), cloth.inverse_masses.end(), 1.0);
    const Bounded grid = bounded(cloth);
    CHECK(grid.bound.maxCoeff() == Approx(6.0 * std::pow(2.0, 1.0 / 32.0)).epsilon(1e-9));
}

TEST_CASE("Chebyshev: the polynomial is 1 at 0, within a third from there on, and damps what it should",
          "[reference]") {
    for (const int products : {1, 2, 3, 6, 20}) {
        CAPTURE(products);
        const double degree = products + 1;
        const double sigma = std::cosh(std::acosh(3.0) / degree), low = (sigma - 1.0) / (sigma + 1.0);
        CHECK(left_of_error(0.0, products) == 1.0);
        double greatest = 0.0;
        for (int n = 0; n <= 1000; ++n) {
            const double left = left_of_error(low + (1.0 - low) * n / 1000.0, products);
            greatest = std::max(greatest, std::abs(left));
        }
        CHECK(greatest == Approx(1.0 / 3.0).epsilon(1e-4));
        // T_degree((1 + low − 2 x)/(1 − low))/3 below as well.
        const double x = 0.5 * low;
        const double argument = (1.0 + low - 2.0 * x) / (1.0 - low);
        CHECK(left_of_error(x, products) == Approx(std::cosh(degree * std::acosh(argument)) / 3.0));
        // The reach that chebyshev_products counts on.
        const double slope = (1.0 - left_of_error(1e-7, products)) / 1e-7;
        CHECK(slope == Approx(1.07 * degree * degree).epsilon(products > 1 ? 0.1 : 0.2));
    }
}

TEST_CASE("Chebyshev: with many products a third of the right-hand side is left, in every mode", "[reference]") {
    test::SampleCloth cloth = test::grid_cloth(9, 9, test::Diagonals::uniform);
    cloth.positions = test::wavy(cloth.positions, 0.1);
    const Bounded b = bounded(cloth);
    // A right-hand side that the matrix reaches: what it cannot change stays whole.
    const TriangleVector<double> wanted = TriangleVector<double>::LinSpaced(b.bound.size(), -1.0, 1.0);
    const TriangleVector<double> right = b.G * wanted;
    const auto scaled_norm = [&](const TriangleVector<double>& r) {
        return r.cwiseQuotient(b.bound.cwiseSqrt()).norm();
    };
    ChebyshevScratch<double> scratch;
    TriangleVector<double> lambda;
    chebyshev<double>(b.G, b.bound, right, 2000, scratch, lambda);
    CHECK(scaled_norm(right - b.G * lambda) <= (1.0 / 3.0 + 1e-9) * scaled_norm(right));
}

TEST_CASE("Chebyshev: products of an α", "[reference]") {
    CHECK(chebyshev_products(1.4, 50) == 2);    // √7 = 2.65
    CHECK(chebyshev_products(1.1, 50) == 4);    // √28 = 5.29
    CHECK(chebyshev_products(1.01, 50) == 16);  // √280 = 16.7
    CHECK(chebyshev_products(10.0, 50) == 1);
    CHECK(chebyshev_products(1.0, 50) == 50);
    CHECK(chebyshev_products(1.01, 7) == 7);
}

TEST_CASE("Chebyshev: the filter brings areas back, and says what it did", "[reference]") {
    test::SampleCloth cloth = test::grid_cloth(17, 17, test::Diagonals::alternating);
    const std::vector<double> start = cloth.positions;
    for (double& x : cloth.positions) x *= 1.1;  // areas off by 21 %
    std::vector<double> velocities(cloth.positions.size(), 0.0);
    reference::StrainLimiter limiter(cloth.topology, {.solver = Solver::chebyshev});
    limiter.enqueue({cloth.positions, velocities, cloth.inverse_masses, cloth.rest_areas, {}},
                    {.regularization = 1.1f, .sub_steps = 10, .stepping = Stepping::whole_step});
    const Stats stats = limiter.read_stats();
    CHECK(stats.status == Status::ok);
    CHECK(stats.initial_max_area_change == Approx(0.21f));
    CHECK(stats.max_area_change < 0.02f);
    CHECK(stats.sub_steps == 10);
    CHECK(stats.iterations == 40);
    CHECK(stats.residual == 0.0f);
}

TEST_CASE("Chebyshev: what it does not take is refused", "[reference]") {
    const test::SampleCloth cloth = test::grid_cloth(3, 3, test::Diagonals::uniform);
    CHECK_THROWS_AS(reference::StrainLimiter(cloth.topology, {.matrix = Matrix::printed, .solver = Solver::chebyshev}),
                    Error);
    CHECK_THROWS_AS(reference::StrainLimiter(cloth.topology, {.warm_start_sub_steps = 1, .solver = Solver::chebyshev}),
                    Error);
    CHECK_THROWS_AS(reference::StrainLimiter(cloth.topology, {.solver = static_cast<Solver>(3)}), Error);
    reference::StrainLimiter limiter(cloth.topology, {.solver = Solver::chebyshev});
    std::vector<double> velocities(cloth.positions.size(), 0.0);
    const std::vector<double> alpha(cloth.rest_areas.size(), 2.0);
    CHECK_THROWS_AS(
        limiter.enqueue({cloth.positions, velocities, cloth.inverse_masses, cloth.rest_areas, alpha}, Parameters{}),
        Error);
    CHECK_THROWS_AS(limiter.enqueue({cloth.positions, velocities, cloth.inverse_masses, cloth.rest_areas, {}},
                                    {.adaptive_threshold = 3}),
                    Error);
}
