// SPDX-License-Identifier: MIT
//
// Entries of both matrices, by hand.

#include "reference/matrix.hpp"

#include "unit/reference/sample_cloths.hpp"

#include <apsl/reference.hpp>

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::reference;

namespace {

/// Two triangles on the edge (0,0,0)-(2,0,0), each wound alike, folded there by the angle of the 3-4-5 triangle:
/// n_a = (0, 0, 1), n_c = (0, 0.6, 0.8).
test::SampleCloth folded_pair() {
    const std::vector<Triangle> triangles{{0, 1, 2}, {1, 0, 3}};
    return {"folded pair", Topology::build(triangles, 4), {0, 0, 0, 2, 0, 0, 0, 1, 0, 1, -4, 3}, {1, 2, 4, 9}, {1, 5}};
}

SparseMatrix<double> matrix_of(const test::SampleCloth& cloth, Matrix matrix) {
    return pressure_matrix<double>(matrix, *cloth.topology, cloth.geometry(), cloth.inverse_masses);
}

}  // namespace

TEST_CASE("the diagonal of one right triangle is Eq. (3)") {
    const test::Mesh mesh = test::right_triangle();
    const test::SampleCloth cloth{"", Topology::build(mesh.triangles, 3), mesh.positions, {1, 2, 4}, {1}};
    // ½ (1·5 + 2·1 + 4·4): squared edges opposite each vertex.
    CHECK(matrix_of(cloth, Matrix::consistent).coeff(0, 0) == Approx(11.5));
    CHECK(matrix_of(cloth, Matrix::printed).coeff(0, 0) == Approx(11.5));
}

TEST_CASE("the printed matrix of a folded pair with unequal masses, by hand") {
    const auto G = matrix_of(folded_pair(), Matrix::printed);
    CHECK(G.coeff(0, 0) == Approx(11.5));  // ½ (1·5 + 2·1 + 4·4)
    CHECK(G.coeff(1, 1) == Approx(57.0));  // ½ (2·26 + 1·26 + 9·4)
    // The vertices opposite the shared edge have w = 4 and 9: ½ √36 · 0.8 · 2².
    CHECK(G.coeff(0, 1) == Approx(9.6));
    CHECK(G.coeff(1, 0) == Approx(9.6));
}

TEST_CASE("the consistent matrix of a folded pair with unequal masses, by hand") {
    const auto G = matrix_of(folded_pair(), Matrix::consistent);
    CHECK(G.coeff(0, 0) == Approx(11.5));
    CHECK(G.coeff(1, 1) == Approx(57.0));
    // Vertex 0: (-1, -2, 0)·(-5, 0.8, -0.6) = 3.4, w = 1. Vertex 1: (1, 0, 0)·(5, 0.8, -0.6) = 5, w = 2. Half their
    // sum.
    CHECK(G.coeff(0, 1) == Approx(6.7));
    CHECK(G.coeff(1, 0) == Approx(6.7));
}

TEST_CASE("both matrices agree on a flat pair of equilateral triangles") {
    const double h = std::sqrt(3.0) / 2.0;
    const std::vector<Triangle> triangles{{0, 1, 2}, {1, 0, 3}};
    const test::SampleCloth cloth{
        "", Topology::build(triangles, 4), {0, 0, 0, 1, 0, 0, 0.5, h, 0, 0.5, -h, 0}, {3, 3, 3, 3}, {h / 2, h / 2}};
    const auto consistent = matrix_of(cloth, Matrix::consistent);
    const auto printed = matrix_of(cloth, Matrix::printed);
    for (int a = 0; a < 2; ++a)
        for (int c = 0; c < 2; ++c) CHECK(consistent.coeff(a, c) == Approx(printed.coeff(a, c)));
    CHECK(printed.coeff(0, 1) == Approx(1.5));  // ½ · 3 · 1 · 1²
}

TEST_CASE("triangles that meet in one vertex only are coupled in the consistent matrix alone") {
    const std::vector<Triangle> triangles{{0, 1, 2}, {0, 3, 4}};
    const test::SampleCloth cloth{"",
                                  Topology::build(triangles, 5),
                                  {0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0},
                                  {2, 1, 1, 1, 1},
                                  {0.5, 0.5}};
    // g at vertex 0: (-1, -1, 0) and (1, 1, 0).
    CHECK(matrix_of(cloth, Matrix::consistent).coeff(0, 1) == Approx(-2.0));
    CHECK(matrix_of(cloth, Matrix::printed).coeff(0, 1) == 0.0);
}

TEST_CASE("regularization multiplies the diagonal and nothing else") {
    const auto G = matrix_of(folded_pair(), Matrix::consistent);
    auto scalar = G;
    regularize(1.5, scalar);
    CHECK(scalar.coeff(0, 0) == Approx(1.5 * 11.5));
    CHECK(scalar.coeff(1, 1) == Approx(1.5 * 57.0));
    CHECK(scalar.coeff(0, 1) == G.coeff(0, 1));

    auto per_triangle = G;
    const std::vector<double> alpha{1.0, 3.0};
    regularize<double>(alpha, per_triangle);
    CHECK(per_triangle.coeff(0, 0) == G.coeff(0, 0));
    CHECK(per_triangle.coeff(1, 1) == Approx(3.0 * 57.0));
    CHECK(per_triangle.coeff(1, 0) == G.coeff(1, 0));
}

TEST_CASE("values are filled in anew over the same structure") {
    const auto cloth = test::grid_cloth(5, 4, test::Diagonals::random);
    for (const Matrix matrix : {Matrix::consistent, Matrix::printed}) {
        const CsrPattern pattern = cloth.topology->csr_pattern(matrix);
        auto G = zero_matrix<double>(pattern);
        CHECK(G.norm() == 0.0);
        CHECK(static_cast<std::size_t>(G.nonZeros()) == pattern.columns.size());
        test::SampleCloth bent = cloth;
        bent.positions = test::wavy(cloth.positions, 0.2);
        for (const auto& shape : {bent, cloth}) {
            const auto geometry = shape.geometry();
            const auto fill = matrix == Matrix::consistent ? consistent_matrix<double> : printed_matrix<double>;
            fill(*cloth.topology, pattern.shared, geometry, cloth.inverse_masses, G);
            CHECK((G - matrix_of(shape, matrix)).norm() == 0.0);
        }
        CHECK((matrix_of(bent, matrix) - matrix_of(cloth, matrix)).norm() > 1e-3 * G.norm());
    }
}
