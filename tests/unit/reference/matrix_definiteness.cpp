// SPDX-License-Identifier: MIT
//
// What the iteration rests on: G is symmetric positive semi-definite; how its scaled spectrum lies; which of the two
// matrices an iterated filter may use.

#include "reference/matrix.hpp"
#include "unit/reference/sample_cloths.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

using namespace apsl;
using namespace apsl::reference;

namespace {

Eigen::MatrixXd dense(const test::SampleCloth& cloth, Matrix matrix) {
    return pressure_matrix<double>(matrix, *cloth.topology, cloth.geometry(), cloth.inverse_masses);
}

/// Eigenvalues of D^-½ G D^-½, ascending.
Eigen::VectorXd scaled_spectrum(const Eigen::MatrixXd& G) {
    const Eigen::VectorXd scale = G.diagonal().cwiseSqrt().cwiseInverse();
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scale.asDiagonal() * G * scale.asDiagonal(),
                                                          Eigen::EigenvaluesOnly)
        .eigenvalues();
}

test::SampleCloth wavy_grid(test::Diagonals diagonals) {
    auto cloth = test::grid_cloth(13, 13, diagonals);
    cloth.positions = test::wavy(cloth.positions, 0.05);
    return cloth;
}

/// A sub-step turns the area error b into (1 − G_true (G + (α − 1) D)⁻¹) b to first order: its spectral radius.
double amplification(const test::SampleCloth& cloth, Matrix matrix, double alpha) {
    Eigen::MatrixXd solved = dense(cloth, matrix);
    solved.diagonal() *= alpha;
    const Eigen::MatrixXd truth = dense(cloth, Matrix::consistent);
    const Eigen::VectorXd mu =
        Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(truth, solved, Eigen::EigenvaluesOnly).eigenvalues();
    return (1.0 - mu.array()).abs().maxCoeff();
}

}  // namespace

TEST_CASE("both matrices are symmetric and positive semi-definite for unequal masses, pins and wavy shapes") {
    for (const auto& cloth : test::wavy_cloths())
        for (const Matrix matrix : {Matrix::consistent, Matrix::printed}) {
            INFO(cloth.name << (matrix == Matrix::consistent ? ", consistent" : ", printed"));
            const Eigen::MatrixXd G = dense(cloth, matrix);
            const double size = G.norm();
            REQUIRE(size > 0.0);
            CHECK((G - G.transpose()).norm() <= 1e-15 * size);
            const Eigen::VectorXd eigenvalues =
                Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(G, Eigen::EigenvaluesOnly).eigenvalues();
            // Backward error of a dense eigenvalue solve: a few ε · ‖G‖.
            CHECK(eigenvalues.minCoeff() >= -1e-14 * size);
        }
}

TEST_CASE("a triangle with three pinned vertices has a zero row and column") {
    auto cloth = test::grid_cloth(4, 4, test::Diagonals::uniform);
    for (const std::uint32_t v : cloth.topology->triangles()[5]) cloth.inverse_masses[v] = 0.0;
    for (const Matrix matrix : {Matrix::consistent, Matrix::printed}) {
        const Eigen::MatrixXd G = dense(cloth, matrix);
        CHECK(G.row(5).isZero(0.0));
        CHECK(G.col(5).isZero(0.0));
    }
}

TEST_CASE("the scaled spectrum reaches 2 on alternating diagonals and nearly 4 on uniform ones") {
    CHECK(scaled_spectrum(dense(wavy_grid(test::Diagonals::alternating), Matrix::consistent)).maxCoeff() ==
          Approx(2.0).margin(0.15));
    CHECK(scaled_spectrum(dense(wavy_grid(test::Diagonals::uniform), Matrix::consistent)).maxCoeff() ==
          Approx(3.9).margin(0.2));
    CHECK(scaled_spectrum(dense(wavy_grid(test::Diagonals::alternating), Matrix::printed)).maxCoeff() ==
          Approx(2.0).margin(0.15));
}

TEST_CASE("a flat alternating grid has null pressures, so pressures are judged by what they do") {
    const auto cloth = test::grid_cloth(13, 13, test::Diagonals::alternating);
    const Eigen::VectorXd spectrum = scaled_spectrum(dense(cloth, Matrix::consistent));
    const auto null_count = (spectrum.array() < 1e-10).count();
    CHECK(static_cast<double>(null_count) / static_cast<double>(spectrum.size()) == Approx(0.2).margin(0.06));
}

TEST_CASE("a sub-step with the consistent matrix never amplifies, one with the printed matrix does for alpha < 2") {
    for (const auto diagonals : {test::Diagonals::alternating, test::Diagonals::uniform}) {
        const auto cloth = wavy_grid(diagonals);
        for (const double alpha : {1.05, 1.2, 2.0, 3.0})
            CHECK(amplification(cloth, Matrix::consistent, alpha) <= 1.0 + 1e-9);
    }
    const auto cloth = wavy_grid(test::Diagonals::alternating);
    const double at_1_05 = amplification(cloth, Matrix::printed, 1.05);
    const double at_1_2 = amplification(cloth, Matrix::printed, 1.2);
    CAPTURE(at_1_05, at_1_2);
    CHECK(at_1_2 > 1.5);
    CHECK(at_1_05 > at_1_2);
}
