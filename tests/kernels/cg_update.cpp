// SPDX-License-Identifier: MIT
#include "kernels/launch.hpp"
#include "reference/conjugate_gradient.hpp"
#include "support/tolerances.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

using namespace apsl;
using namespace apsl::test;

namespace {

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

// ‖b − A y‖ / ‖b‖ of the device's unknowns, through the reference's operator in double precision. Not the pressures
// themselves: the matrix can have null vectors.
double true_residual(const ScaledSolve& solve, const std::vector<double>& y) {
    const auto size = static_cast<Eigen::Index>(y.size());
    const Eigen::Map<const Eigen::VectorXd> b(solve.right_hand_side.data(), size);
    return (b - solve.rows * Eigen::Map<const Eigen::VectorXd>(y.data(), size)).norm() / b.norm();
}

// The reference's relative residual after so many iterations.
double reference_residual(const ScaledSolve& solve, int iterations) {
    const Eigen::VectorXd b = Eigen::Map<const Eigen::VectorXd>(
        solve.right_hand_side.data(), static_cast<Eigen::Index>(solve.right_hand_side.size()));
    reference::ConjugateGradientScratch<double> scratch;
    Eigen::VectorXd lambda;
    return reference::conjugate_gradient<double>(solve.rows, b, 0.0, iterations, scratch, lambda).relative_residual;
}

}  // namespace

TEST_CASE("cg_update: two iterations by hand, awkward sizes in every work-group size", "[cg_update]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const std::uint32_t size : awkward_sizes(group)) {
            CAPTURE(group, size);
            const Build build{.work_group_size = group};
            const std::vector<Cloth> cloths{make_cloth(strip(size), 1), make_cloth(strip(5), 2)};
            Arrays arrays(cloths, Matrix::consistent, paper_setting, 3);
            std::vector<std::vector<double>> r(2), p(2), s(2), y(2);
            std::vector<double> gamma(2), previous_gamma(2), previous_step(2);
            for (std::size_t c = 0; c < 2; ++c) r[c] = arrays.of_cloth(arrays.residual.read(), c);

            // One step solves one row.
            for (int k = 0; k < (size == 1 ? 1 : 2); ++k) {
                // Stands in for A r; near enough to r that the curvature is positive.
                const std::vector<float> product = arrays.over_triangles([&](std::size_t c, std::size_t a) {
                    return r[c][a] * (1.0 + 0.3 * std::sin(static_cast<double>(a + k)));
                });
                arrays.product.write(product);
                const int slot = k & 1;
                for (std::size_t c = 0; c < 2; ++c) {
                    const std::vector<double> q = arrays.of_cloth(product, c);
                    gamma[c] = dot(r[c], r[c]);
                    const double curvature = dot(r[c], q);
                    arrays.write_partial_sum(c, APSLK_PARTIAL_CURVATURE, curvature);
                    const double beta = k == 0 ? 0.0 : gamma[c] / previous_gamma[c];
                    const double step =
                        gamma[c] / (k == 0 ? curvature : curvature - beta * gamma[c] / previous_step[c]);
                    p[c].resize(r[c].size());
                    s[c].resize(r[c].size());
                    y[c].resize(r[c].size());
                    for (std::size_t a = 0; a < r[c].size(); ++a) {
                        p[c][a] = r[c][a] + beta * p[c][a];
                        s[c][a] = q[a] + beta * s[c][a];
                        y[c][a] += step * p[c][a];
                        r[c][a] -= step * s[c][a];
                    }
                    previous_gamma[c] = gamma[c];
                    previous_step[c] = step;
                }
                std::size_t c = 0;
                arrays.edit_states([&](apslk_solve_state& state) {
                    state.scaled_residual[slot] = static_cast<float>(gamma[c]);
                    ++c;
                });
                launch::cg_update(arrays, build, k);
                for (c = 0; c < 2; ++c) {
                    // Norms of what goes into the updates: r − α s cancels. The second step stands on the first's
                    // rounding, and on a step length whose denominator cancels too.
                    const double roundings = k == 0 ? 8 : 60;
                    const double scale = std::sqrt(gamma[c]) + previous_step[c] * norm(s[c]);
                    CHECK(difference(arrays.of_cloth(arrays.residual.read(), c), r[c]) <=
                          elementwise_tolerance(roundings) * scale);
                    CHECK(difference(arrays.of_cloth(arrays.direction.read(), c), p[c]) <=
                          elementwise_tolerance(roundings) * (norm(p[c]) + scale));
                    CHECK(difference(arrays.of_cloth(arrays.direction_product.read(), c), s[c]) <=
                          elementwise_tolerance(roundings) * (norm(s[c]) + scale));
                    CHECK(difference(arrays.of_cloth(arrays.pressure.read(), c), y[c]) <=
                          elementwise_tolerance(roundings) * (norm(y[c]) + previous_step[c] * scale));
                    const std::vector<double> left = arrays.of_cloth(arrays.residual.read(), c);
                    const auto check_sum = [&](int even_kind, double expected) {
                        const std::vector<double> parts = arrays.partials_of(c, even_kind + (slot ^ 1));
                        CHECK(std::abs(std::accumulate(parts.begin(), parts.end(), 0.0) - expected) <=
                              sum_tolerance(3, left.size()) * expected);
                    };
                    check_sum(APSLK_PARTIAL_SCALED_RESIDUAL_EVEN, dot(left, left));
                    check_sum(APSLK_PARTIAL_RESIDUAL_EVEN, arrays.unscaled_squared(c, left));
                    CHECK(arrays.states.read()[c].solve_iterations == k + 1);
                    for (const float padding : arrays.padding_of(arrays.residual.read())) CHECK(padding == 0.0f);
                    // On with the device's own numbers.
                    r[c] = left;
                }
            }
        }
}

TEST_CASE("cg_update with csr_spmv_dot: as good a solution as the reference's, iteration by iteration", "[cg_update]") {
    for (const Matrix matrix : {Matrix::consistent, Matrix::printed}) {
        const Build build{.work_group_size = 32, .matrix = matrix};
        const std::vector<Cloth> cloths{make_cloth(grid(17, 17, 1.0, 1.0, Diagonals::alternating), 1)};
        Arrays arrays(cloths, matrix, {.tolerance = 0.0f}, 4);
        for (int k = 0; k < 12; ++k) {
            launch::csr_spmv_dot(arrays, build, k);
            launch::cg_update(arrays, build, k);
            CAPTURE(static_cast<int>(matrix), k);
            const double residual = true_residual(arrays.solves[0], arrays.of_cloth(arrays.pressure.read(), 0));
            const double expected = reference_residual(arrays.solves[0], k + 1);
            // In 32 bits the two recurrences drift apart by rounding, amplified by the condition number (about 20 at
            // α = 1.2), and from iteration to iteration.
            CHECK(std::abs(residual - expected) <= 20.0 * (k + 1) * epsilon + 0.01 * expected);
        }
        CHECK(arrays.states.read()[0].solve_iterations == 12);
    }
}

TEST_CASE("cg_update: a solve that has ended writes nothing and hands its residual on", "[cg_update]") {
    const std::vector<Cloth> cloths{make_cloth(strip(100), 1)};
    Arrays arrays(cloths, Matrix::consistent, paper_setting, 3);
    arrays.product.write(arrays.residual.read());
    arrays.write_partials(0, APSLK_PARTIAL_RESIDUAL_EVEN, {1.0, 2.0, 3.0});
    arrays.write_partials(0, APSLK_PARTIAL_SCALED_RESIDUAL_EVEN, {4.0, 5.0, 6.0});
    arrays.write_partials(0, APSLK_PARTIAL_CURVATURE, {1.0, 1.0, 1.0});
    const std::vector<float> residual = arrays.residual.read();
    arrays.edit_states([](apslk_solve_state& state) {
        state.iterating = 0;
        state.scaled_residual[0] = 6.0f;
    });
    launch::cg_update(arrays, {}, 0);
    CHECK(same_bytes(residual, arrays.residual.read()));
    CHECK(same_bytes(arrays.pressure.read(), poison<float>(arrays.pressure.size())));
    CHECK(same_bytes(arrays.direction.read(), poison<float>(arrays.direction.size())));
    CHECK(arrays.partials_of(0, APSLK_PARTIAL_RESIDUAL_ODD) == std::vector<double>{1.0, 2.0, 3.0});
    CHECK(arrays.partials_of(0, APSLK_PARTIAL_SCALED_RESIDUAL_ODD) == std::vector<double>{4.0, 5.0, 6.0});
    CHECK(arrays.states.read()[0].solve_iterations == 0);
}

TEST_CASE("cg_update: no positive curvature, no step, then or later in the solve", "[cg_update]") {
    for (const double curvature : {0.0, -1.0, 1e-30}) {
        CAPTURE(curvature);
        const std::vector<Cloth> cloths{make_cloth(strip(100), 1)};
        Arrays arrays(cloths, Matrix::consistent, paper_setting, 3);
        const std::vector<float> residual = arrays.residual.read();
        arrays.product.write(std::vector<float>(residual.size(), 0.0f));
        arrays.write_partial_sum(0, APSLK_PARTIAL_RESIDUAL_EVEN, 2.0);
        arrays.write_partial_sum(0, APSLK_PARTIAL_CURVATURE, curvature);
        // A former solve's leavings, of any value.
        arrays.edit_states([](apslk_solve_state& state) {
            state.scaled_residual[0] = state.scaled_residual[1] = 2.0f;
            state.step[0] = state.step[1] = -3.0f;
        });
        for (int k = 0; k < 3; ++k) launch::cg_update(arrays, {}, k);
        CHECK(same_bytes(residual, arrays.residual.read()));
        CHECK(arrays.states.read()[0].solve_iterations == 0);
    }
}
