// SPDX-License-Identifier: MIT
#include "reference/chebyshev.hpp"

#include "chebyshev_products.hpp"
#include "kernels/launch.hpp"
#include "support/tolerances.hpp"

#include <catch2/catch.hpp>
#include <cstring>

using namespace apsl;
using namespace apsl::test;

namespace {

// What the polynomial of the reference makes of the right-hand side, in the scaled unknowns: the stored gradients are
// those over √(ρ D), with one ρ for all.
std::vector<double> expected(const Arrays& arrays, std::size_t c, double rho, int products) {
    const ScaledSolve& solve = arrays.solves[c];
    const auto size = static_cast<Eigen::Index>(solve.scale.size());
    reference::SparseMatrix<double> scaled = solve.rows;  // S (G + (ρ − 1) D) S, with a diagonal of 1
    for (Eigen::Index a = 0; a < size; ++a)
        if (solve.scale[a] > 0.0) scaled.coeffRef(a, a) -= (rho - 1.0) / rho;
    const Eigen::VectorXd bound = Eigen::Map<const Eigen::VectorXd>(solve.scale.data(), size).unaryExpr([](double s) {
        return s > 0.0 ? 1.0 : 0.0;
    });
    const Eigen::VectorXd b = Eigen::Map<const Eigen::VectorXd>(solve.right_hand_side.data(), size);
    reference::ChebyshevScratch<double> scratch;
    reference::TriangleVector<double> y;
    reference::chebyshev<double>(scaled, bound, b, products, scratch, y);
    return {y.data(), y.data() + y.size()};
}

void check_pressures(const Arrays& arrays, std::size_t c, double rho, int products) {
    CAPTURE(c, products);
    const std::vector<double> want = expected(arrays, c, rho, products);
    const std::vector<double> got = arrays.of_cloth(arrays.pressure.read(), c);
    // Every product is off by the gradients' rounding, and a gain of at most 4 multiplies each.
    const double each = stored_product_tolerance + elementwise_tolerance(30);
    CHECK(difference(got, want) <= 4.0 * products * each * norm(want));
    CHECK(arrays.states.read()[c].solve_iterations == products);
}

}  // namespace

TEST_CASE("chebyshev_step: the polynomial of the reference, on every kind of mesh", "[chebyshev]") {
    constexpr float rho = 4.0f;  // above the greatest eigenvalue of any of these
    for (const std::uint32_t group : work_group_sizes())
        for (const float alpha : {3.0f, 1.3f, 1.1f}) {  // 1, 2 and 4 products
            CAPTURE(group, alpha);
            const Build build{.work_group_size = group, .chebyshev = true};
            Arrays arrays(every_kind_of_mesh(), Matrix::consistent, {.regularization = rho, .sub_steps = 1}, 3);
            std::vector<apsl_parameters> parameters = arrays.parameters.read();
            for (apsl_parameters& p : parameters) p.regularization = alpha;
            arrays.parameters.write(parameters);
            const int products = chebyshev_products(alpha, 50);
            for (int k = 0; k < products; ++k) launch::chebyshev_step(arrays, build, 0, products, k);
            for (std::size_t c = 0; c < arrays.cloth_count(); ++c) check_pressures(arrays, c, rho, products);
        }
}

TEST_CASE("chebyshev_step: each cloth as many products as its α takes, a stopped one none", "[chebyshev]") {
    constexpr float rho = 4.0f;
    const Build build{.work_group_size = 64, .chebyshev = true};
    const std::vector<Cloth> cloths{make_cloth(grid(9, 9, 1.0, 1.0, Diagonals::alternating), 1),
                                    make_cloth(grid(9, 8, 1.0, 1.0, Diagonals::uniform), 2), make_cloth(fan(12), 3),
                                    make_cloth(book(4), 4)};
    Arrays arrays(cloths, Matrix::consistent, {.regularization = rho, .sub_steps = 1}, 2);
    std::vector<apsl_parameters> parameters = arrays.parameters.read();
    const float alphas[] = {1.05f, 1.4f, 3.0f, 1.05f};
    for (std::size_t c = 0; c < 4; ++c) parameters[c].regularization = alphas[c];
    arrays.parameters.write(parameters);
    std::vector<apsl_solve_state> states = arrays.states.read();
    states[3].stopped = 1;
    arrays.states.write(states);
    const std::vector<double> before = arrays.of_cloth(arrays.pressure.read(), 3);

    const int launched = chebyshev_products(1.05f, 50);
    REQUIRE(launched == 6);
    for (int k = 0; k < launched; ++k) launch::chebyshev_step(arrays, build, 0, launched, k);
    for (std::size_t c = 0; c < 3; ++c) check_pressures(arrays, c, rho, chebyshev_products(alphas[c], 50));
    const std::vector<double> after = arrays.of_cloth(arrays.pressure.read(), 3);
    CHECK(std::memcmp(before.data(), after.data(), before.size() * sizeof(double)) == 0);
    CHECK(arrays.states.read()[3].solve_iterations == 0);
}

TEST_CASE("chebyshev_step: the schedule's α, and the same bytes again", "[chebyshev]") {
    constexpr float rho = 4.0f;
    const Build build{.work_group_size = 32, .chebyshev = true};
    const Parameters rising{.regularization = 1.4f, .sub_steps = 3, .first_regularization = 1.1f};
    std::vector<std::vector<float>> pressures;
    for (const int sub_step : {0, 1, 2, 2}) {
        Arrays arrays(every_kind_of_mesh(), Matrix::consistent, {.regularization = rho, .sub_steps = 1}, 3);
        std::vector<apsl_parameters> parameters = arrays.parameters.read();
        const float step = std::log2(0.1f / 0.4f) / 2.0f;
        for (apsl_parameters& p : parameters) {
            p.regularization = rising.regularization;
            p.damping_step = step;
            p.sub_steps = 3;
        }
        arrays.parameters.write(parameters);
        const int products = chebyshev_products(1.0 + 0.1 * std::pow(2.0, sub_step), 50);
        for (int k = 0; k < products; ++k) launch::chebyshev_step(arrays, build, sub_step, products, k);
        check_pressures(arrays, 0, rho, products);
        pressures.push_back(arrays.pressure.read());
    }
    CHECK(same_bytes(pressures[2], pressures[3]));
    CHECK(!same_bytes(pressures[1], pressures[2]));
}

TEST_CASE("bound_vertices, bound_triangles: the reference's bound with a tenth more, over D", "[bound_matrix]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const float scaled_by : {1.0f, 3.0f}) {  // the bound there was: none, and one
            CAPTURE(group, scaled_by);
            const Build build{.work_group_size = group, .chebyshev = true};
            const std::vector<Cloth> cloths = every_kind_of_mesh();
            Arrays arrays(cloths, Matrix::consistent, {.regularization = scaled_by, .sub_steps = 1}, 3);
            arrays.ordered_regularization.write(
                arrays.over_triangles([&](std::size_t, std::size_t) { return static_cast<double>(scaled_by); }));
            launch::bound_vertices(arrays, build);
            launch::bound_triangles(arrays, build);
            const std::vector<float> bound = arrays.ordered_regularization.read();
            for (const float padding : arrays.padding_of(bound)) CHECK(padding == 0.0f);
            for (std::size_t c = 0; c < cloths.size(); ++c) {
                CAPTURE(c);
                reference::TriangleVector<double> want;
                reference::diagonal_bound<double>(*cloths[c].topology, arrays.solves[c].geometry,
                                                  cloths[c].inverse_masses, want);
                const std::vector<double> got = arrays.of_cloth(bound, c);
                for (std::size_t a = 0; a < got.size(); ++a) {
                    const double diagonal = arrays.solves[c].damped_diagonal[a] / static_cast<double>(scaled_by);
                    if (diagonal > 0.0)
                        CHECK(got[a] == Approx(1.1 * want[static_cast<Eigen::Index>(a)] / diagonal).epsilon(1e-3));
                    else
                        CHECK(got[a] == 16.0);
                }
            }
        }
}

TEST_CASE("assemble_gradients for a Chebyshev solve: scaled by the bound, no shift", "[assemble_gradients]") {
    for (const std::uint32_t group : work_group_sizes()) {
        CAPTURE(group);
        const std::vector<Cloth> cloths = every_kind_of_mesh();
        // The sample's own α take the place of the bound: one kernel must do with it what the other does with α.
        Arrays damped(cloths, Matrix::consistent, {.sub_steps = 1}, 3, true),
            bounded(cloths, Matrix::consistent, {.sub_steps = 1}, 3, true);
        launch::assemble_gradients(damped, {.work_group_size = group, .alpha_per_triangle = true});
        launch::assemble_gradients(bounded, {.work_group_size = group, .chebyshev = true});
        CHECK(same_bytes(bounded.residual.read(), damped.residual.read()));
        CHECK(same_bytes(bounded.damped_diagonal.read(), damped.damped_diagonal.read()));
        const std::vector<Gradients> got = bounded.gradients.read(), want = damped.gradients.read();
        for (std::size_t a = 0; a < got.size(); ++a) {
            CHECK(std::memcmp(got[a].corner, want[a].corner, sizeof got[a].corner) == 0);
            CHECK(got[a].shift == 0.0f);
        }
    }
}
