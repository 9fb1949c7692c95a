// SPDX-License-Identifier: MIT
#include "kernels/launch.hpp"
#include "support/tolerances.hpp"

#include <catch2/catch.hpp>
#include <numeric>

using namespace apsl;
using namespace apsl::test;

namespace {

constexpr Parameters long_solve{.regularization = 1.05f, .sub_steps = 10, .tolerance = 1e-4f, .max_iterations = 60};

void iterate(Arrays& arrays, const Build& build, int from, int to) {
    for (int k = from; k < to; ++k) {
        launch::matrix_free_apply_dot(arrays, build, k);
        launch::cg_update(arrays, build, k);
    }
}

double residual_left(const Arrays& arrays, std::size_t cloth) {
    const std::vector<double> parts = arrays.partials_of(cloth, APSLK_PARTIAL_RESIDUAL_EVEN);
    return std::sqrt(std::accumulate(parts.begin(), parts.end(), 0.0));
}

// ‖b − A y‖ in the scaled unknowns, A of the reference: the matrix can have null vectors, so pressures themselves may
// differ.
double true_residual(const Arrays& arrays, std::size_t cloth) {
    const ScaledSolve& solve = arrays.solves[cloth];
    const std::vector<double> y = arrays.of_cloth(arrays.pressure.read(), cloth);
    const auto size = static_cast<Eigen::Index>(y.size());
    return (Eigen::Map<const Eigen::VectorXd>(solve.right_hand_side.data(), size) -
            solve.rows * Eigen::Map<const Eigen::VectorXd>(y.data(), size))
        .norm();
}

struct Everything {
    std::vector<float> residual, pressure, direction, partials;
    std::vector<apslk_solve_state> states;
};

Everything read(const Arrays& arrays) {
    return {arrays.residual.read(), arrays.pressure.read(), arrays.direction.read(), arrays.partials.read(),
            arrays.states.read()};
}

void check_same(const Everything& before, const Everything& after) {
    CHECK(same_bytes(before.residual, after.residual));
    CHECK(same_bytes(before.pressure, after.pressure));
    CHECK(same_bytes(before.direction, after.direction));
    CHECK(same_bytes(before.partials, after.partials));
    CHECK(same_bytes(before.states, after.states));
}

}  // namespace

TEST_CASE("finish_solve: goes on exactly where queued iterations ended", "[finish_solve]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const int queued : {2, 8}) {
            CAPTURE(group, queued);
            const Build build{.work_group_size = group};
            const std::vector<Cloth> cloths{make_cloth(grid(17, 15, 1.0, 1.0, Diagonals::alternating), 1),
                                            make_cloth(strip(101), 2), make_cloth(right_triangle(), 3)};
            Arrays finished(cloths, Matrix::consistent, long_solve, 3);
            Arrays queued_on(cloths, Matrix::consistent, long_solve, 3);
            iterate(finished, build, 0, queued);
            launch::finish_solve(finished, build, queued);
            iterate(queued_on, build, 0, 60);
            for (std::size_t c = 0; c < cloths.size(); ++c) {
                CAPTURE(c);
                const int iterations = finished.states.read()[c].solve_iterations;
                const double initial = norm(finished.solves[c].right_hand_side);
                const double plain_initial = std::sqrt(finished.states.read()[c].initial_squared_residual);
                CHECK(iterations > (c < 2 ? queued : 0));
                CHECK(iterations < 60);
                // Sums are grouped otherwise: rounding may bring the end an iteration forward or back.
                CHECK(std::abs(iterations - queued_on.states.read()[c].solve_iterations) <= 1);
                CHECK(residual_left(finished, c) <= 1e-4 * plain_initial);
                CHECK(residual_left(queued_on, c) <= 1e-4 * plain_initial);
                // The true residual also has the error of the stored gradients, times the solution's size.
                const std::vector<double> y = finished.of_cloth(finished.pressure.read(), c);
                const double stored = stored_product_tolerance * norm(y);
                CHECK(true_residual(finished, c) <= 1e-3 * initial + stored);
                CHECK(true_residual(queued_on, c) <= 1e-3 * initial + stored);
            }
        }
}

TEST_CASE("finish_solve: two iterations are the two that cg_update would have done", "[finish_solve]") {
    for (const std::uint32_t group : work_group_sizes()) {
        CAPTURE(group);
        const Build build{.work_group_size = group};
        const Parameters six{.regularization = 1.05f, .sub_steps = 10, .tolerance = 0.0f, .max_iterations = 6};
        const std::vector<Cloth> cloths{make_cloth(grid(17, 15, 1.0, 1.0, Diagonals::alternating), 1)};
        Arrays finished(cloths, Matrix::consistent, six, 3), queued_on(cloths, Matrix::consistent, six, 3);
        iterate(finished, build, 0, 4);
        launch::finish_solve(finished, build, 4);
        iterate(queued_on, build, 0, 6);
        CHECK(finished.states.read()[0].solve_iterations == 6);
        const auto check_near = [&](DeviceArray<float> Arrays::* array, const char* name) {
            CAPTURE(name);
            const std::vector<double> got = finished.of_cloth((finished.*array).read(), 0);
            const std::vector<double> want = queued_on.of_cloth((queued_on.*array).read(), 0);
            // Step lengths differ by the rounding of their sums; the residual is what is left after cancellation.
            CHECK(difference(got, want) <= elementwise_tolerance(60) * norm(finished.solves[0].right_hand_side));
        };
        check_near(&Arrays::residual, "residual");
        check_near(&Arrays::pressure, "pressure");
        check_near(&Arrays::direction, "direction");
        CHECK(std::abs(residual_left(finished, 0) - residual_left(queued_on, 0)) <=
              elementwise_tolerance(60) * std::sqrt(finished.states.read()[0].initial_squared_residual));
    }
}

TEST_CASE("finish_solve: the same bytes twice", "[finish_solve]") {
    const std::vector<Cloth> cloths{make_cloth(grid(17, 15, 1.0, 1.0, Diagonals::random), 1)};
    for (const std::uint32_t group : work_group_sizes()) {
        const Build build{.work_group_size = group};
        Arrays first(cloths, Matrix::consistent, long_solve, 3), second(cloths, Matrix::consistent, long_solve, 3);
        for (Arrays* arrays : {&first, &second}) {
            iterate(*arrays, build, 0, 4);
            launch::finish_solve(*arrays, build, 4);
        }
        check_same(read(first), read(second));
    }
}

TEST_CASE("finish_solve: takes up no solve that has stopped, converged, broken down or used its iterations",
          "[finish_solve]") {
    const std::vector<Cloth> cloths{make_cloth(strip(101), 1)};
    for (const std::uint32_t group : {1u, 64u}) {
        CAPTURE(group);
        const Build build{.work_group_size = group};
        Arrays stopped(cloths, Matrix::consistent, long_solve, 3);
        iterate(stopped, build, 0, 4);
        stopped.edit_states([](apslk_solve_state& state) { state.stopped = 1; });
        const Everything before_stopped = read(stopped);
        launch::finish_solve(stopped, build, 4);
        check_same(before_stopped, read(stopped));

        // Converged before the last queued iteration.
        Arrays converged(cloths, Matrix::consistent, {.regularization = 1.2f, .sub_steps = 10, .tolerance = 0.1f}, 3);
        iterate(converged, build, 0, 20);
        REQUIRE(converged.states.read()[0].solve_iterations < 20);
        const Everything before_converged = read(converged);
        launch::finish_solve(converged, build, 20);
        check_same(before_converged, read(converged));

        // Broken down: after a step of zero there is no other.
        Arrays broken(cloths, Matrix::consistent, long_solve, 3);
        iterate(broken, build, 0, 3);
        broken.edit_states([](apslk_solve_state& state) { state.step[0] = 0.0f; });
        iterate(broken, build, 3, 4);
        REQUIRE(broken.states.read()[0].solve_iterations == 3);
        const Everything before_broken = read(broken);
        launch::finish_solve(broken, build, 4);
        check_same(before_broken, read(broken));

        // Converged with the last queued iteration, or out of iterations: the residual's parts may be gathered into
        // one, their sum and all else stay.
        for (const bool out_of_iterations : {false, true}) {
            CAPTURE(out_of_iterations);
            Arrays ended(cloths, Matrix::consistent,
                         {.regularization = 1.2f, .sub_steps = 10, .tolerance = 0.0f, .max_iterations = 2}, 3);
            iterate(ended, build, 0, 2);
            REQUIRE(ended.states.read()[0].solve_iterations == 2);
            if (!out_of_iterations) {
                std::vector<apslk_parameters> parameters = ended.parameters.read();
                parameters[0].max_iterations = 50;
                parameters[0].tolerance_squared = 0.99f;
                ended.parameters.write(parameters);
            }
            const Everything before = read(ended);
            const double left = residual_left(ended, 0);
            launch::finish_solve(ended, build, 2);
            const Everything after = read(ended);
            CHECK(same_bytes(before.residual, after.residual));
            CHECK(same_bytes(before.pressure, after.pressure));
            CHECK(same_bytes(before.states, after.states));
            CHECK(std::abs(residual_left(ended, 0) - left) <= elementwise_tolerance(3) * left);
        }
    }
}
