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

TEST_CASE("chebyshev_step: the polynomial of the reference, on every kind of mesh", "[chebyshev_step]") {
    constexpr float rho = 4.0f;  // above the greatest eigenvalue of any of these
    for (const std::uint32_t group : work_group_sizes())
        for (const float alpha : {3.0f, 1.3f, 1.1f}) {  // 1, 2 and 4 products
            CAPTURE(group, alpha);
            const Build build{.work_group_size = group, .chebyshev = true};
            Arrays arrays(every_kind_of_mesh(), Matrix::consistent, {.regularization = rho, .sub_steps = 1}, 3);
            std::vector<apslk_parameters> parameters = arrays.parameters.read();
            for (apslk_parameters& p : parameters) p.regularization = alpha;
            arrays.parameters.write(parameters);
            const int products = chebyshev_products(alpha, 50);
            for (int k = 0; k < products; ++k) launch::chebyshev_step(arrays, build, 0, products, k);
            for (std::size_t c = 0; c < arrays.cloth_count(); ++c) check_pressures(arrays, c, rho, products);
        }
}

TEST_CASE("chebyshev_step: each cloth as many products as its α takes, a stopped one none", "[chebyshev_step]") {
    constexpr float rho = 4.0f;
    const Build build{.work_group_size = 64, .chebyshev = true};
    const std::vector<Cloth> cloths{make_cloth(grid(9, 9, 1.0, 1.0, Diagonals::alternating), 1),
                                    make_cloth(grid(9, 8, 1.0, 1.0, Diagonals::uniform), 2), make_cloth(fan(12), 3),
                                    make_cloth(book(4), 4)};
    Arrays arrays(cloths, Matrix::consistent, {.regularization = rho, .sub_steps = 1}, 2);
    std::vector<apslk_parameters> parameters = arrays.parameters.read();
    const float alphas[] = {1.05f, 1.4f, 3.0f, 1.05f};
    for (std::size_t c = 0; c < 4; ++c) parameters[c].regularization = alphas[c];
    arrays.parameters.write(parameters);
    std::vector<apslk_solve_state> states = arrays.states.read();
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

TEST_CASE("chebyshev_step: the schedule's α, and the same bytes again", "[chebyshev_step]") {
    constexpr float rho = 4.0f;
    const Build build{.work_group_size = 32, .chebyshev = true};
    const Parameters rising{.regularization = 1.4f, .sub_steps = 3, .first_regularization = 1.1f};
    std::vector<std::vector<float>> pressures;
    for (const int sub_step : {0, 1, 2, 2}) {
        Arrays arrays(every_kind_of_mesh(), Matrix::consistent, {.regularization = rho, .sub_steps = 1}, 3);
        std::vector<apslk_parameters> parameters = arrays.parameters.read();
        const float step = std::log2(0.1f / 0.4f) / 2.0f;
        for (apslk_parameters& p : parameters) {
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

TEST_CASE("bound_vertices: the reference's bounds, a fifth more where a mass is raised", "[bound_vertices]") {
    constexpr Parameters small_steps{.sub_steps = 30};
    for (const std::uint32_t group : work_group_sizes())
        for (const bool raised : {false, true}) {
            CAPTURE(group, raised);
            const std::vector<Cloth> cloths = every_kind_of_mesh();
            Arrays arrays(cloths, Matrix::consistent, small_steps, 3);
            std::vector<cl_float4> given = arrays.moved.read();
            if (raised)
                for (cl_float4& vertex : given) vertex.s[3] *= 2.0f;
            arrays.motion.write(given);
            launch::bound_vertices(arrays, {.work_group_size = group, .chebyshev = true});
            const std::vector<float> got = arrays.vertex_bounds.read();
            std::size_t i = 0;
            for (std::size_t c = 0; c < cloths.size(); ++c) {
                std::vector<double> want;
                reference::vertex_bounds<double>(*cloths[c].topology, arrays.solves[c].geometry, want);
                for (std::size_t v = 0; v < want.size(); ++v, ++i) {
                    if (cloths[c].inverse_masses[v] == 0.0) continue;  // no gradient is stored there
                    CAPTURE(c, v);
                    const double margin = raised ? 1.2 : 1.0;
                    CHECK(static_cast<double>(got[arrays.vertex_places[i]]) == Approx(margin * want[v]).epsilon(2e-2));
                }
            }
        }
}

TEST_CASE("bound_vertices: a gradient of zero counts as one of any direction", "[bound_vertices]") {
    const std::vector<Cloth> cloths{make_cloth(grid(9, 9, 1.0, 1.0, Diagonals::random), 1)};
    Arrays arrays(cloths, Matrix::consistent, {.sub_steps = 30}, 2);
    arrays.motion.write(arrays.moved.read());
    std::vector<Gradients> gradients = arrays.gradients.read();
    std::vector<reference::TriangleGeometry<double>> geometry = arrays.solves[0].geometry;
    for (std::size_t a = 0; a < geometry.size(); a += 7) {
        for (cl_short4& corner : gradients[arrays.triangle_places[0][a]].corner) corner = {{0, 0, 0, 0}};
        for (auto& gradient : geometry[a].gradients) gradient.setZero();
    }
    arrays.gradients.write(gradients);
    launch::bound_vertices(arrays, {.chebyshev = true});
    std::vector<double> want, without;
    reference::vertex_bounds<double>(*cloths[0].topology, geometry, want);
    reference::vertex_bounds<double>(*cloths[0].topology, arrays.solves[0].geometry, without);
    CHECK(want != without);
    const std::vector<float> got = arrays.vertex_bounds.read();
    for (std::size_t v = 0; v < want.size(); ++v) {
        CAPTURE(v);
        if (cloths[0].inverse_masses[v] == 0.0) continue;  // no gradient is stored there
        CHECK(static_cast<double>(got[arrays.vertex_places[v]]) == Approx(want[v]).epsilon(2e-2));
    }
}

TEST_CASE("assemble_gradients for a Chebyshev solve: scaled by the bound, no shift", "[assemble_gradients]") {
    for (const std::uint32_t group : work_group_sizes()) {
        CAPTURE(group);
        const std::vector<Cloth> cloths = every_kind_of_mesh();
        Arrays arrays(cloths, Matrix::consistent, {.sub_steps = 1}, 3);
        std::vector<float> bounds(arrays.vertex_bounds.size());
        for (std::size_t place = 0; place < bounds.size(); ++place)
            bounds[place] = 1.0f + 0.25f * static_cast<float>(place % 9);
        arrays.vertex_bounds.write(bounds);
        launch::assemble_gradients(arrays, {.work_group_size = group, .chebyshev = true});
        const std::vector<Gradients> gradients = arrays.gradients.read();
        std::size_t first = 0;
        for (std::size_t c = 0; c < cloths.size(); ++c) {
            std::vector<double> own(cloths[c].topology->vertex_count());
            for (std::size_t v = 0; v < own.size(); ++v) own[v] = bounds[arrays.vertex_places[first + v]];
            first += own.size();
            reference::TriangleVector<double> want;
            reference::diagonal_bound<double>(*cloths[c].topology, arrays.solves[c].geometry, cloths[c].inverse_masses,
                                              own, want);
            const std::vector<double> got = arrays.of_cloth(arrays.scaled_diagonal.read(), c);
            for (std::size_t a = 0; a < got.size(); ++a) {
                CAPTURE(c, a);
                // The reference's gradients of a triangle without area are zero; a length has no direction to lose.
                if (arrays.solves[c].geometry[a].area > 0.0)
                    CHECK(got[a] == Approx(1.1 * want[static_cast<Eigen::Index>(a)]).epsilon(1e-4).margin(1e-12));
                CHECK(gradients[arrays.triangle_places[c][a]].shift == 0.0f);
            }
        }
    }
}
