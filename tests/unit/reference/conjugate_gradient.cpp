// SPDX-License-Identifier: MIT
#include "reference/conjugate_gradient.hpp"

#include "reference/direct_solve.hpp"
#include "unit/reference/sample_cloths.hpp"

#include <apsl/error.hpp>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace apsl;
using namespace apsl::reference;

namespace {

template <class Real>
struct Solved : SolveResult<Real> {
    TriangleVector<Real> lambda;
};

template <class Real>
Solved<Real> solve(const SparseMatrix<Real>& A, const TriangleVector<Real>& b, Real tolerance, int max_iterations) {
    ConjugateGradientScratch<Real> scratch;
    TriangleVector<Real> lambda;
    const auto result = conjugate_gradient<Real>(A, b, tolerance, max_iterations, scratch, lambda);
    return {result, lambda};
}

/// The regularised system of a cloth at its present shape.
struct System {
    SparseMatrix<double> A;
    TriangleVector<double> b;
};

System system_of(const test::SampleCloth& cloth, Matrix matrix, double alpha) {
    const auto geometry = cloth.geometry();
    System system{pressure_matrix<double>(matrix, *cloth.topology, geometry, cloth.inverse_masses), {}};
    regularize(alpha, system.A);
    system.b.resize(static_cast<Eigen::Index>(geometry.size()));
    for (std::size_t a = 0; a < geometry.size(); ++a) system.b[a] = geometry[a].area - cloth.rest_areas[a];
    return system;
}

System wavy_grid_system(std::uint32_t side, double alpha) {
    auto cloth = test::grid_cloth(side, side, test::Diagonals::alternating);
    cloth.positions = test::wavy(cloth.positions, 0.1);
    return system_of(cloth, Matrix::consistent, alpha);
}

/// ‖r‖ over rows with D > 0.
double norm(const System& system, const TriangleVector<double>& r) {
    double sum = 0.0;
    for (Eigen::Index a = 0; a < r.size(); ++a)
        if (system.A.coeff(a, a) > 0.0) sum += r[a] * r[a];
    return std::sqrt(sum);
}

}  // namespace

TEST_CASE("Conjugate Gradient agrees with the direct solve on every kind of cloth") {
    for (const auto& cloth : test::wavy_cloths())
        for (const Matrix matrix : {Matrix::consistent, Matrix::printed})
            for (const double alpha : {1.01, 1.2, 1e6}) {
                INFO(cloth.name << ", alpha " << alpha);
                const System system = system_of(cloth, matrix, alpha);
                const auto iterated = solve(system.A, system.b, 1e-12, 1000);
                const TriangleVector<double> direct = direct_solve(system.A, system.b);
                CHECK(iterated.converged);
                // κ ≤ ~4 / 0.01 and tolerance 1e-12.
                CHECK((iterated.lambda - direct).norm() <= 1e-9 * direct.norm());
            }
}

TEST_CASE("the iteration stops as soon as its norm of the residual is within the tolerance, and reports it truly") {
    const System system = wavy_grid_system(17, 1.05);
    for (const double tolerance : {0.5, 0.1, 1e-3, 1e-8}) {
        const auto solved = solve(system.A, system.b, tolerance, 1000);
        const double residual = norm(system, system.b - system.A * solved.lambda) / norm(system, system.b);
        CAPTURE(tolerance, solved.iterations);
        CHECK(solved.converged);
        CHECK(residual <= tolerance * (1 + 1e-6));
        CHECK(solved.relative_residual == Approx(residual).margin(1e-12));

        const auto cut_short = solve(system.A, system.b, tolerance, solved.iterations - 1);
        if (solved.iterations > 1) {
            CHECK_FALSE(cut_short.converged);
            CHECK(cut_short.iterations == solved.iterations - 1);
            CHECK(cut_short.relative_residual > tolerance);
        }
    }
}

TEST_CASE("the number of iterations depends on alpha, not on the size of the mesh") {
    const auto iterations = [](std::uint32_t side, double alpha) {
        const System system = wavy_grid_system(side, alpha);
        return solve(system.A, system.b, 1e-6, 1000).iterations;
    };
    // ½ √κ ln(2/tol) with κ ≤ (α + 3) / (α − 1): the scaled spectrum of G ends below 4. 33 at 1.2, 10 at 5.
    for (const std::uint32_t side : {17u, 33u, 129u}) {
        CAPTURE(side);
        CHECK(iterations(side, 1.2) <= 33);
        CHECK(iterations(side, 5.0) <= 10);
    }
    // 64 times the triangles; without regularization the iterations grow with the side, here eightfold.
    CHECK(iterations(129, 1.2) < 2 * iterations(17, 1.2));
    CHECK(iterations(33, 5.0) < iterations(33, 1.2));
}

TEST_CASE("rows with a zero diagonal get no pressure and disturb nobody") {
    auto cloth = test::grid_cloth(6, 6, test::Diagonals::uniform);
    cloth.positions = test::wavy(cloth.positions, 0.1);
    for (const std::uint32_t v : cloth.topology->triangles()[11]) cloth.inverse_masses[v] = 0.0;
    for (const Matrix matrix : {Matrix::consistent, Matrix::printed}) {
        const System system = system_of(cloth, matrix, 1.2);
        REQUIRE(system.A.coeff(11, 11) == 0.0);
        REQUIRE(system.b[11] != 0.0);
        const auto iterated = solve(system.A, system.b, 1e-12, 1000);
        CHECK(iterated.converged);
        CHECK(iterated.lambda[11] == 0.0);
        const TriangleVector<double> direct = direct_solve(system.A, system.b);
        CHECK(direct[11] == 0.0);
        CHECK((iterated.lambda - direct).norm() <= 1e-10 * direct.norm());
    }
}

TEST_CASE("no residual, no work") {
    System system = wavy_grid_system(5, 1.2);
    system.b.setZero();
    const auto solved = solve(system.A, system.b, 0.1, 50);
    CHECK(solved.converged);
    CHECK(solved.iterations == 0);
    CHECK(solved.relative_residual == 0.0);
    CHECK(solved.lambda.isZero(0.0));
}

TEST_CASE("alpha = 1 leaves a singular system: the iteration ends, with finite pressures") {
    auto cloth = test::grid_cloth(17, 17, test::Diagonals::alternating);
    for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v) {
        cloth.positions[3 * v] *= 1.3;
        cloth.positions[3 * v + 2] *= 1.0 + 0.1 * cloth.positions[3 * v];
    }
    const System system = system_of(cloth, Matrix::consistent, 1.0);
    for (const int most : {1, 50, 2000}) {
        const auto solved = solve(system.A, system.b, 0.0, most);
        CHECK(solved.iterations <= most);
        CHECK(std::isfinite(solved.relative_residual));
        CHECK(solved.lambda.allFinite());
        CHECK_FALSE(solved.converged);
    }
    const auto in_float = solve<float>(system.A.cast<float>(), system.b.cast<float>(), 0.0f, 2000);
    CHECK(in_float.lambda.allFinite());
}

TEST_CASE("a direction that the matrix maps to zero ends the iteration") {
    // λ = (1, −1) is null, and b is nothing but that.
    SparseMatrix<double> A(2, 2);
    for (int a = 0; a < 2; ++a)
        for (int c = 0; c < 2; ++c) A.insert(a, c) = 1.0;
    const auto solved = solve<double>(A, TriangleVector<double>{{1.0, -1.0}}, 0.1, 50);
    CHECK_FALSE(solved.converged);
    CHECK(solved.iterations == 0);
    CHECK(solved.lambda.isZero(0.0));
    CHECK_THROWS_WITH(direct_solve<double>(A, TriangleVector<double>{{1.0, -1.0}}),
                      "the matrix has a zero pivot, expected it positive definite (regularization > 1)");
}

TEST_CASE("numbers that are not finite are told, not iterated on") {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        System system = wavy_grid_system(5, 1.2);
        system.b[3] = bad;
        auto solved = solve(system.A, system.b, 0.1, 50);
        CHECK_FALSE(solved.converged);
        CHECK(std::isnan(solved.relative_residual));

        system = wavy_grid_system(5, 1.2);
        system.A.coeffRef(0, 1) = bad;
        solved = solve(system.A, system.b, 0.1, 50);
        CHECK_FALSE(solved.converged);
        CHECK(std::isnan(solved.relative_residual));
    }
}

TEST_CASE("a first guess: any multiple of the solution ends the solve at once") {
    const System system = wavy_grid_system(9, 1.2);
    const TriangleVector<double> solution = solve<double>(system.A, system.b, 1e-12, 500).lambda;
    ConjugateGradientScratch<double> scratch;
    for (const double multiple : {1.0, -3.0, 1e-6}) {
        TriangleVector<double> lambda = multiple * solution;
        const auto result = conjugate_gradient<double>(system.A, system.b, 1e-8, 50, scratch, lambda, true);
        CHECK(result.converged);
        CHECK(result.iterations == 0);
        CHECK(result.relative_residual <= 1e-8);
        CHECK((lambda - solution).norm() <= 1e-8 * solution.norm());
    }
}

TEST_CASE("a first guess that is zero, not finite or worthless is none") {
    const System system = wavy_grid_system(9, 1.2);
    const auto plain = solve<double>(system.A, system.b, 1e-3, 50);
    ConjugateGradientScratch<double> scratch;
    for (const double value :
         {0.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        TriangleVector<double> lambda = TriangleVector<double>::Constant(system.b.size(), value);
        const auto result = conjugate_gradient<double>(system.A, system.b, 1e-3, 50, scratch, lambda, true);
        CHECK(result.iterations == plain.iterations);
        CHECK(lambda == plain.lambda);
    }
    // A wrong one is no obstacle.
    TriangleVector<double> lambda = TriangleVector<double>::Constant(system.b.size(), 1e9);
    CHECK(conjugate_gradient<double>(system.A, system.b, 1e-3, 50, scratch, lambda, true).converged);
    CHECK((system.b - system.A * lambda).norm() <= 2e-3 * system.b.norm());
}
