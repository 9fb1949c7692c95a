// SPDX-License-Identifier: MIT
//
// The scaled matrix, assembled or not, against the reference's: entry by entry, and applied to a vector.
#include "kernels/launch.hpp"
#include "support/tolerances.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

using namespace apsl;
using namespace apsl::test;

namespace {

// An entry is about thirty roundings, each at most of the size of a diagonal entry (1).
constexpr double entry_roundings = 30;

const Matrix matrices[] = {Matrix::consistent, Matrix::printed};

void check_values(Arrays& arrays, const Build& build) {
    const std::vector<float> expected = arrays.values.read();  // the reference's, before they are poisoned
    arrays.values.write(poison<float>(expected.size()));
    launch::assemble_pressure_csr(arrays, build);
    const std::vector<float> values = arrays.values.read();
    const std::vector<double> got(values.begin(), values.end()), want(expected.begin(), expected.end());
    // Every row has a diagonal of 1, so this norm is of the size of √T.
    CHECK(difference(got, want) <= (elementwise_tolerance(entry_roundings) + stored_product_tolerance) * norm(want));
}

// q = A r and r·q for a vector r, from either way to apply A.
void check_product(Arrays& arrays, const Build& build, bool assembled) {
    arrays.residual.write(arrays.over_triangles([](std::size_t c, std::size_t a) {
        return std::sin(1.7 * static_cast<double>(a) + static_cast<double>(c)) + 0.2;
    }));
    arrays.product.write(arrays.poisoned_triangles());
    if (assembled)
        launch::csr_spmv_dot(arrays, build, 0);
    else
        launch::matrix_free_apply_dot(arrays, build, 0);

    const std::vector<float> residual = arrays.residual.read();
    const std::vector<float> product = arrays.product.read();
    const std::vector<apslk_solve_state> states = arrays.states.read();
    for (const float padding : arrays.padding_of(product)) CHECK(padding == 0.0f);
    for (std::size_t c = 0; c < arrays.cloth_count(); ++c) {
        const std::vector<double> r = arrays.of_cloth(residual, c);
        const Eigen::Map<const Eigen::VectorXd> vector(r.data(), static_cast<Eigen::Index>(r.size()));
        const Eigen::VectorXd want = arrays.solves[c].rows * vector;
        const Eigen::VectorXd magnitudes = arrays.solves[c].rows.cwiseAbs() * vector.cwiseAbs();
        const std::vector<double> got = arrays.of_cloth(product, c);
        // The assembled rows are the reference's own; without them the matrix comes of stored gradients.
        const double stored = assembled ? 0.0 : stored_product_tolerance;
        CHECK(difference(got, {want.data(), got.size()}) <=
              (elementwise_tolerance(entry_roundings) + stored) * magnitudes.norm());

        const std::vector<double> parts = arrays.partials_of(c, APSLK_PARTIAL_CURVATURE);
        const double curvature = std::accumulate(parts.begin(), parts.end(), 0.0);
        CHECK(std::abs(curvature - vector.dot(want)) <=
              (sum_tolerance(entry_roundings, r.size()) + stored) * vector.cwiseAbs().dot(magnitudes));
        CHECK(states[c].iterating == 1);
        // γ, published by the first group.
        const std::vector<double> gamma = arrays.partials_of(c, APSLK_PARTIAL_SCALED_RESIDUAL_EVEN);
        CHECK(static_cast<double>(states[c].scaled_residual[0]) == std::accumulate(gamma.begin(), gamma.end(), 0.0));
    }
}

}  // namespace

TEST_CASE("assemble_pressure_csr: both matrices on every kind of mesh", "[assemble_pressure_csr]") {
    for (const Matrix matrix : matrices) {
        CAPTURE(static_cast<int>(matrix));
        const std::vector<Cloth> cloths = every_kind_of_mesh();
        Arrays arrays(cloths, matrix, {}, 2, true);
        check_values(arrays, {.work_group_size = 32, .matrix = matrix, .alpha_per_triangle = true});
        const std::vector<float> first = arrays.values.read();
        launch::assemble_pressure_csr(arrays, {.work_group_size = 32, .matrix = matrix, .alpha_per_triangle = true});
        CHECK(same_bytes(first, arrays.values.read()));
    }
}

TEST_CASE("assemble_pressure_csr: awkward sizes in every work-group size", "[assemble_pressure_csr]") {
    for (const Matrix matrix : matrices)
        for (const std::uint32_t group : work_group_sizes())
            for (const std::uint32_t size : awkward_sizes(group)) {
                CAPTURE(static_cast<int>(matrix), group, size);
                const std::vector<Cloth> cloths{make_cloth(strip(size), 1), make_cloth(strip(5), 2)};
                Arrays arrays(cloths, matrix, {}, 3);
                check_values(arrays, {.work_group_size = group, .matrix = matrix});
            }
}

TEST_CASE("csr_spmv_dot: awkward sizes in every work-group size", "[csr_spmv_dot]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const std::uint32_t size : awkward_sizes(group)) {
            CAPTURE(group, size);
            const std::vector<Cloth> cloths{make_cloth(strip(size), 1), make_cloth(strip(5), 2)};
            Arrays arrays(cloths, Matrix::consistent, paper_setting, 3);
            check_product(arrays, {.work_group_size = group}, true);
        }
}

TEST_CASE("matrix_free_apply_dot: awkward sizes in every work-group size", "[matrix_free_apply_dot]") {
    for (const Matrix matrix : matrices)
        for (const std::uint32_t group : work_group_sizes())
            for (const std::uint32_t size : awkward_sizes(group)) {
                CAPTURE(static_cast<int>(matrix), group, size);
                const std::vector<Cloth> cloths{make_cloth(strip(size), 1), make_cloth(strip(5), 2)};
                Arrays arrays(cloths, matrix, {}, 3);
                check_product(arrays, {.work_group_size = group, .matrix = matrix}, false);
            }
}

TEST_CASE("csr_spmv_dot and matrix_free_apply_dot: every kind of mesh, the same bytes twice",
          "[csr_spmv_dot][matrix_free_apply_dot]") {
    for (const Matrix matrix : matrices)
        for (const bool assembled : {true, false}) {
            CAPTURE(static_cast<int>(matrix), assembled);
            const Build build{.work_group_size = 32, .matrix = matrix, .alpha_per_triangle = true};
            const std::vector<Cloth> cloths = every_kind_of_mesh();
            Arrays arrays(cloths, matrix, {}, 2, true);
            check_product(arrays, build, assembled);
            const std::vector<float> product = arrays.product.read();
            const std::vector<float> partials = arrays.partials.read();
            check_product(arrays, build, assembled);
            CHECK(same_bytes(product, arrays.product.read()));
            CHECK(same_bytes(partials, arrays.partials.read()));
        }
}

TEST_CASE("csr_spmv_dot and matrix_free_apply_dot: nothing is written once stopped, converged or out of iterations",
          "[csr_spmv_dot][matrix_free_apply_dot]") {
    const std::vector<Cloth> cloths{make_cloth(strip(100), 1)};
    for (const Matrix matrix : matrices)
        for (const bool assembled : {true, false}) {
            const Build build{.matrix = matrix};
            const auto check_idle = [&](Arrays& arrays, int iteration) {
                CAPTURE(static_cast<int>(matrix), assembled, iteration);
                if (assembled)
                    launch::csr_spmv_dot(arrays, build, iteration);
                else
                    launch::matrix_free_apply_dot(arrays, build, iteration);
                CHECK(arrays.states.read()[0].iterating == 0);
                CHECK(same_bytes(arrays.product.read(), arrays.poisoned_triangles()));
            };
            Arrays stopped(cloths, matrix, {}, 2);
            stopped.edit_states([](apslk_solve_state& state) { state.stopped = 1; });
            check_idle(stopped, 0);

            Arrays converged(cloths, matrix, {.tolerance = 0.1f}, 2);
            const double initial = static_cast<double>(converged.states.read()[0].initial_squared_residual);
            converged.write_partial_sum(0, APSLK_PARTIAL_RESIDUAL_ODD, 0.0099 * initial);
            check_idle(converged, 1);

            Arrays out_of_iterations(cloths, matrix, {.max_iterations = 3}, 2);
            out_of_iterations.write_partial_sum(0, APSLK_PARTIAL_RESIDUAL_ODD, initial);
            check_idle(out_of_iterations, 3);
        }
}
