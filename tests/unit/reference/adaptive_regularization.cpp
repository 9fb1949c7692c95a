// SPDX-License-Identifier: MIT
//
// Section 4: α raised where CG fails or takes too many iterations, restored where it takes few.
#include "reference/adaptive_regularization.hpp"
#include "unit/reference/run_filter.hpp"

#include <catch2/catch.hpp>

using namespace apsl;
using namespace apsl::reference;

namespace {

/// A grid cloth whose velocities stretch it by a fifth both ways in a step.
struct Stretched {
    test::SampleCloth cloth = test::grid_cloth(33, 33, test::Diagonals::alternating);
    std::vector<double> velocities;

    Stretched() {
        std::vector<double> target = cloth.positions;
        for (std::size_t n = 0; n < target.size(); ++n) target[n] *= n / 3 % 2 == 0 ? 1.2 : 1.19;
        velocities = test::velocities_towards(cloth, target, Parameters{}.time_step);
    }
};

/// A limiter that lives on from call to call; each call begins with the same velocities.
struct Calls {
    Stretched stretched;
    BasicStrainLimiter<double> limiter{stretched.cloth.topology};
    std::vector<double> velocities;

    Stats call(const Parameters& parameters) {
        velocities = stretched.velocities;
        limiter.enqueue(
            {stretched.cloth.positions, velocities, stretched.cloth.inverse_masses, stretched.cloth.rest_areas, {}},
            parameters);
        return limiter.read_stats();
    }
};

}  // namespace

TEST_CASE("raised alpha: alpha - 1 times the factor, with a floor that lets 1 be raised") {
    CHECK(raised_regularization(1.2, 1.0) == 1.2);
    CHECK(raised_regularization(1.2, 2.0) == Approx(1.4));
    CHECK(raised_regularization(1.2, 8.0) == Approx(2.6));
    CHECK(raised_regularization(1.0, 1.0) == 1.0);
    CHECK(raised_regularization(1.0, 2.0) == Approx(1.05));
    CHECK(raised_regularization(1.01, 3.0) == Approx(1.11));
}

TEST_CASE("the factor doubles after a failed or long solve, halves after a short one, within 1 and 1024") {
    const Parameters parameters{.adaptive_threshold = 10};
    CHECK(adapted_factor(2.0, parameters, 11, true) == 4.0);
    CHECK(adapted_factor(2.0, parameters, 1, false) == 4.0);
    CHECK(adapted_factor(2.0, parameters, 10, true) == 2.0);
    CHECK(adapted_factor(2.0, parameters, 6, true) == 2.0);
    CHECK(adapted_factor(4.0, parameters, 5, true) == 2.0);
    CHECK(adapted_factor(1.0, parameters, 0, true) == 1.0);
    CHECK(adapted_factor(1.5, parameters, 1, true) == 1.0);
    CHECK(adapted_factor(1024.0, parameters, 99, false) == 1024.0);
    CHECK(adapted_factor(8.0, Parameters{.adaptive_threshold = 0}, 99, false) == 1.0);
}

TEST_CASE("alpha rises until solves fit their iterations, and later solves converge") {
    const Parameters hard{
        .regularization = 1.01f, .sub_steps = 1, .tolerance = 0.1f, .max_iterations = 3, .adaptive_threshold = 3};
    Parameters fixed = hard;
    fixed.adaptive_threshold = 0;
    Calls adaptive, plain;
    CHECK(plain.call(fixed).status != Status::ok);
    std::vector<Status> statuses;
    std::vector<float> residuals;
    for (int call = 0; call < 12; ++call) {
        const Stats stats = adaptive.call(hard);
        statuses.push_back(stats.status);
        residuals.push_back(stats.residual);
        CHECK(plain.call(fixed).status != Status::ok);  // not_converged, and where it overshot worsened
    }
    CHECK(statuses.front() != Status::ok);
    CHECK(statuses.back() == Status::ok);
    // While it fails, every rise of α makes the same system easier.
    for (std::size_t n = 1; n < statuses.size() && statuses[n - 1] != Status::ok; ++n)
        CHECK(residuals[n] < residuals[n - 1]);
}

TEST_CASE("alpha comes back to what was given once solves take few iterations") {
    const Parameters hard{
        .regularization = 1.2f, .sub_steps = 3, .tolerance = 1e-3f, .max_iterations = 2, .adaptive_threshold = 2};
    const Parameters easy{
        .regularization = 1.2f, .sub_steps = 3, .tolerance = 0.1f, .max_iterations = 50, .adaptive_threshold = 40};
    Calls calls, fresh;
    calls.call(hard);
    const std::vector<double> given = (fresh.call(easy), fresh.velocities);
    calls.call(easy);
    CHECK(calls.velocities != given);  // still raised
    for (int call = 0; call < 4; ++call) calls.call(easy);
    CHECK(calls.velocities == given);  // to the bit
}

TEST_CASE("adaptive_threshold of 0 leaves every bit as it is, and forgets what was raised") {
    const Parameters plain{.regularization = 1.05f, .sub_steps = 4};
    Parameters never_needed = plain;
    never_needed.adaptive_threshold = 1000;
    Calls one, two;
    one.call(plain);
    two.call(never_needed);
    CHECK(one.velocities == two.velocities);

    Parameters always = plain;
    always.adaptive_threshold = 1;
    two.call(always);
    CHECK(one.velocities != two.velocities);
    Parameters single = plain;
    single.sub_steps = 1;
    two.call(single);  // the first solve still has the factor of the call before
    two.call(plain);
    CHECK(one.velocities == two.velocities);
}
