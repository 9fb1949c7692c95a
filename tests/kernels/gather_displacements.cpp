// SPDX-License-Identifier: MIT
#include "kernels/launch.hpp"
#include "reference/displacements.hpp"
#include "reference/effective_masses.hpp"
#include "support/tolerances.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;

namespace {

void with_pressure(Arrays& arrays) {
    arrays.edit_states([](apslk_solve_state& state) { state.solve_iterations = 3; });
    arrays.pressure.write(arrays.over_triangles([](std::size_t c, std::size_t a) {
        return 0.01 * std::cos(2.3 * static_cast<double>(a) + static_cast<double>(c));
    }));
}

void check_displaced(Arrays& arrays, const Build& build) {
    with_pressure(arrays);
    const std::vector<cl_float4> before = arrays.moved.read();
    launch::gather_displacements(arrays, build, 0);
    const std::vector<cl_float4> after = arrays.moved.read();
    const std::vector<float> pressure = arrays.pressure.read();
    for (std::size_t c = 0; c < arrays.cloth_count(); ++c) {
        const Cloth& cloth = arrays.sources[c];
        std::vector<double> lambda = arrays.of_cloth(pressure, c);
        for (std::size_t a = 0; a < lambda.size(); ++a) lambda[a] *= arrays.solves[c].scale[a];
        std::vector<double> moves;
        reference::displacements<double>(*cloth.topology, arrays.solves[c].geometry, cloth.inverse_masses, lambda,
                                         moves);
        std::vector<double> got, want, scale, stored;
        for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v) {
            const std::size_t i = arrays.vertex_places[arrays.adjacency.cloths[c].vertex_begin + v];
            for (std::size_t k = 0; k < 3; ++k) {
                got.push_back(static_cast<double>(after[i].s[k]));
                want.push_back(cloth.positions[3 * v + k] + moves[3 * v + k]);
                if (cloth.inverse_masses[v] == 0.0) CHECK(after[i].s[k] == before[i].s[k]);
            }
            CHECK(after[i].s[3] == before[i].s[3]);
            // Magnitudes of the terms of the vertex' sum: they cancel.
            double terms = 0.0, pressures = 0.0;
            for (std::uint32_t n = cloth.topology->corner_offsets()[v]; n < cloth.topology->corner_offsets()[v + 1];
                 ++n) {
                const Corner corner = cloth.topology->corners()[n];
                pressures += std::abs(pressure[arrays.triangle_places[c][corner / 3]]);
                terms +=
                    std::abs(lambda[corner / 3]) * arrays.solves[c].geometry[corner / 3].gradients[corner % 3].norm();
            }
            scale.push_back(cloth.inverse_masses[v] * terms);
            // √(2 w) Σ y ḡ, with half a unit of error in each of the three components of ḡ.
            stored.push_back(std::sqrt(2.0 * cloth.inverse_masses[v]) * pressures * 0.5 * std::sqrt(3.0));
        }
        CHECK(difference(got, want) <= elementwise_tolerance(8) * norm(scale) + gradient_unit * norm(stored) +
                                           elementwise_tolerance(1) * norm(want));
    }
}

}  // namespace

TEST_CASE("gather_displacements: awkward sizes in every work-group size", "[gather_displacements]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const std::uint32_t size : awkward_sizes(group)) {
            CAPTURE(group, size);
            const std::vector<Cloth> cloths{make_cloth(strip(size), 1), make_cloth(strip(5), 2)};
            Arrays arrays(cloths, Matrix::consistent, paper_setting, 3);
            check_displaced(arrays, {.work_group_size = group});
        }
}

TEST_CASE("gather_displacements: every kind of mesh, the same bytes twice", "[gather_displacements]") {
    const std::vector<Cloth> cloths{make_cloth(grid(9, 11, 1.0, 1.0, Diagonals::alternating), 1),
                                    make_cloth(tetrahedron(), 3), make_cloth(book(4), 4), make_cloth(fan(30), 5),
                                    make_cloth(right_triangle(), 6)};
    Arrays arrays(cloths, Matrix::consistent, paper_setting, 2);
    const std::vector<cl_float4> before = arrays.moved.read();
    check_displaced(arrays, {});
    const std::vector<cl_float4> first = arrays.moved.read();
    arrays.moved.write(before);
    check_displaced(arrays, {});
    CHECK(same_bytes(first, arrays.moved.read()));
}

TEST_CASE("gather_displacements: moves nothing once stopped or without a pressure", "[gather_displacements]") {
    const std::vector<Cloth> cloths{make_cloth(strip(100), 1)};
    Arrays arrays(cloths, Matrix::consistent, paper_setting, 2);
    const std::vector<cl_float4> before = arrays.moved.read();
    with_pressure(arrays);
    arrays.edit_states([](apslk_solve_state& state) { state.stopped = 1; });
    launch::gather_displacements(arrays, {}, 0);
    CHECK(same_bytes(before, arrays.moved.read()));
    CHECK(arrays.stats.read()[0].residual == 0.0f);

    arrays.edit_states([](apslk_solve_state& state) { state.stopped = state.solve_iterations = 0; });
    arrays.pressure.write(poison<float>(arrays.pressure.size()));
    launch::gather_displacements(arrays, {}, 0);
    CHECK(same_bytes(before, arrays.moved.read()));
}

TEST_CASE("gather_displacements: keeps the greatest residual and says where the tolerance was missed",
          "[gather_displacements]") {
    const std::vector<Cloth> cloths{make_cloth(strip(100), 1)};
    Arrays arrays(cloths, Matrix::consistent, {.regularization = 1.2f, .sub_steps = 10, .tolerance = 0.1f}, 3);
    with_pressure(arrays);
    arrays.edit_states([](apslk_solve_state& state) { state.initial_squared_residual = 100.0f; });
    const auto end_with = [&](const std::vector<double>& residual_squared) {
        arrays.write_partials(0, APSLK_PARTIAL_RESIDUAL_ODD, residual_squared);
        launch::gather_displacements(arrays, {}, 1);
        return arrays.stats.read()[0];
    };
    const apslk_stats met = end_with({0.2, 0.3, 0.14});  // √0.64 / 10
    CHECK(std::abs(static_cast<double>(met.residual) - 0.08) <= elementwise_tolerance(4) * 0.08);
    CHECK(met.status == APSLK_STATUS_OK);
    const apslk_stats missed = end_with({2.0, 1.0, 1.0});
    CHECK(std::abs(static_cast<double>(missed.residual) - 0.2) <= elementwise_tolerance(4) * 0.2);
    CHECK(missed.status == APSLK_STATUS_NOT_CONVERGED);
    const apslk_stats met_again = end_with({0.2, 0.3, 0.14});
    CHECK(met_again.residual == missed.residual);
    CHECK(met_again.status == APSLK_STATUS_NOT_CONVERGED);
}

TEST_CASE("gather_displacements: counts iterations and adapts alpha's factor", "[gather_displacements]") {
    const std::vector<Cloth> cloths{make_cloth(strip(100), 1)};
    Arrays arrays(cloths, Matrix::consistent,
                  {.regularization = 1.2f, .sub_steps = 10, .tolerance = 0.1f, .adaptive_threshold = 10}, 2);
    with_pressure(arrays);
    const auto factor_after = [&](float factor, int iterations, double relative_residual) {
        arrays.edit_states([&](apslk_solve_state& state) {
            state.initial_squared_residual = 1.0f;
            state.adaptive_factor = factor;
            state.solve_iterations = iterations;
        });
        arrays.write_partial_sum(0, APSLK_PARTIAL_RESIDUAL_EVEN, relative_residual * relative_residual);
        launch::gather_displacements(arrays, {}, 0);
        return arrays.states.read()[0].adaptive_factor;
    };
    CHECK(factor_after(4.0f, 11, 0.05) == 8.0f);  // too many
    CHECK(factor_after(4.0f, 3, 0.2) == 8.0f);    // not converged
    CHECK(factor_after(4.0f, 10, 0.05) == 4.0f);
    CHECK(factor_after(4.0f, 6, 0.05) == 4.0f);
    CHECK(factor_after(4.0f, 5, 0.05) == 2.0f);  // at most half
    CHECK(factor_after(1.0f, 1, 0.05) == 1.0f);
    CHECK(factor_after(1024.0f, 11, 0.05) == 1024.0f);
    CHECK(arrays.stats.read()[0].iterations == 11 + 3 + 10 + 6 + 5 + 1 + 11);

    arrays.edit_states([](apslk_solve_state& state) { state.stopped = 1; });
    CHECK(factor_after(4.0f, 11, 0.05) == 4.0f);
    CHECK(arrays.stats.read()[0].iterations == 47);
}

TEST_CASE(
    "gather_displacements: in small steps vertices too light for their tension move less, and weigh more from then on",
    "[gather_displacements][small_steps]") {
    constexpr Parameters small_steps{.sub_steps = 30};
    const std::vector<Cloth> cloths{make_cloth(grid(9, 9, 1.0, 1.0, Diagonals::random), 1)};
    const Cloth& cloth = cloths[0];
    Arrays arrays(cloths, Matrix::consistent, small_steps, 2);
    const ScaledSolve& solve = arrays.solves[0];
    std::vector<double> lambda(solve.scale.size());
    for (std::size_t a = 0; a < lambda.size(); ++a) lambda[a] = 0.3 + std::cos(2.3 * static_cast<double>(a));
    reference::EffectiveMasses<double> masses;
    masses.start(cloth.inverse_masses);
    masses.find_tension(*cloth.topology, solve.geometry, lambda);
    // So strong that about half of the vertices are too light.
    std::vector<double> demands;
    for (std::size_t v = 0; v < masses.tension.size(); ++v)
        if (cloth.inverse_masses[v] > 0.0) demands.push_back(2.0 * masses.tension[v] * cloth.inverse_masses[v]);
    std::nth_element(demands.begin(), demands.begin() + static_cast<std::ptrdiff_t>(demands.size() / 2), demands.end());
    for (double& pressure : lambda) pressure /= demands[demands.size() / 2];
    masses.find_tension(*cloth.topology, solve.geometry, lambda);
    std::vector<double> moves;
    reference::displacements<double>(*cloth.topology, solve.geometry, cloth.inverse_masses, lambda, moves);

    arrays.edit_states([&](apslk_solve_state& state) {
        state.solve_iterations = 3;
        state.greatest_mass = static_cast<float>(masses.greatest);
    });
    arrays.pressure.write(arrays.over_triangles(
        [&](std::size_t, std::size_t a) { return solve.scale[a] > 0.0 ? lambda[a] / solve.scale[a] : 0.0; }));
    const std::vector<cl_float4> before = arrays.moved.read();
    std::vector<cl_float4> still = before;
    for (cl_float4& step : still) step.s[0] = step.s[1] = step.s[2] = 0.0f;
    arrays.motion.write(still);
    arrays.total_correction.write(std::vector<cl_float4>(before.size(), cl_float4{{0.0f, 0.0f, 0.0f, 0.0f}}));
    constexpr int last_part = 28;  // of 29: nothing is carried on
    launch::gather_displacements(arrays, {}, 0, last_part);
    const std::vector<cl_float4> after = arrays.moved.read();

    std::size_t raised = 0;
    std::vector<double> got, want;
    std::vector<double> shares;
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v)
        shares.push_back(masses.share_taken(v, cloth.inverse_masses[v]));
    masses.raise(cloth.inverse_masses);
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
        CAPTURE(v);
        const std::size_t i = arrays.vertex_places[v];
        CHECK(static_cast<double>(after[i].s[3]) == Approx(masses.inverse[v]).epsilon(1e-2));
        raised += after[i].s[3] < before[i].s[3];
        for (std::size_t k = 0; k < 3; ++k) {
            got.push_back(static_cast<double>(after[i].s[k]) - static_cast<double>(before[i].s[k]));
            want.push_back(shares[v] * moves[3 * v + k]);
        }
    }
    CHECK(raised > cloth.inverse_masses.size() / 4);
    CHECK(raised < cloth.inverse_masses.size() * 3 / 4);
    CHECK(*std::min_element(shares.begin(), shares.end()) < 0.9);
    CHECK(difference(got, want) <= 1e-2 * norm(want));
}

TEST_CASE("gather_displacements: in small steps a displacement changes the velocity and carries on",
          "[gather_displacements][small_steps]") {
    // Four parts; sub-step 1 leaves two of them after its own, sub-step 3 none, sub-step 4 only corrects.
    constexpr Parameters small_steps{.regularization = 1.2f, .sub_steps = 5, .stepping = Stepping::small_steps};
    const std::vector<Cloth> cloths{make_cloth(strip(300), 1)};
    for (const std::uint32_t group : work_group_sizes()) {
        Arrays whole(cloths, Matrix::consistent, paper_setting, 3);
        with_pressure(whole);
        const std::vector<cl_float4> before = whole.moved.read();
        launch::gather_displacements(whole, {.work_group_size = group}, 0);
        const std::vector<cl_float4> moved = whole.moved.read();
        for (const auto& [sub_step, carried, onward] :
             {std::tuple{1, 3.0, 0.25}, std::tuple{3, 1.0, 0.0}, std::tuple{4, 1.0, 0.0}}) {
            CAPTURE(group, sub_step);
            Arrays arrays(cloths, Matrix::consistent, small_steps, 3);
            with_pressure(arrays);
            const std::vector<cl_float4> zeros(before.size(), cl_float4{{0.0f, 0.0f, 0.0f, 0.0f}});
            const std::vector<cl_float4> steps(before.size(), cl_float4{{0.5f, -0.25f, 1.0f, 0.0f}});
            arrays.total_correction.write(zeros);
            arrays.motion.write(steps);
            launch::gather_displacements(arrays, {.work_group_size = group}, 0, sub_step);
            const std::vector<cl_float4> after = arrays.moved.read(), total_correction = arrays.total_correction.read();
            std::vector<double> errors, sizes;
            for (std::size_t i = 0; i < before.size(); ++i)
                for (std::size_t k = 0; k < 3; ++k) {
                    const double change = static_cast<double>(moved[i].s[k]) - static_cast<double>(before[i].s[k]);
                    const double step = static_cast<double>(steps[i].s[k]) + 4.0 * change;
                    errors.push_back(static_cast<double>(total_correction[i].s[k]) - carried * change);
                    errors.push_back(static_cast<double>(after[i].s[k]) -
                                     (static_cast<double>(before[i].s[k]) + change + onward * step));
                    sizes.push_back(std::abs(static_cast<double>(before[i].s[k])) + 1.0);
                    if (before[i].s[3] == 0.0f) CHECK(total_correction[i].s[k] == 0.0f);
                }
            CHECK(norm(errors) <= elementwise_tolerance(12) * norm(sizes));
        }
    }
}
