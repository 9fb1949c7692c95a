// SPDX-License-Identifier: MIT
#include "resolved_parameters.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace apsl;

namespace {

constexpr Options with_ceiling{.limits_stretch = true};

/// Sub-steps after follow(excess, asked), and whether small steps grew alike.
int followed(const Parameters& parameters, double excess, float asked) {
    ResolvedParameters resolved(parameters, with_ceiling);
    resolved.follow(excess, asked);
    CHECK(resolved.small_steps == resolved.sub_steps - 1);
    return resolved.sub_steps;
}

}  // namespace

TEST_CASE("automatic sub-steps: twice as many at most, where they may follow") {
    const auto most = [](const Parameters& parameters, const Options& options) {
        return ResolvedParameters(parameters, options).most_sub_steps;
    };
    CHECK(most({.sub_steps = 30}, with_ceiling) == 60);
    CHECK(most({.sub_steps = 30}, {}) == 30);
    CHECK(most({.sub_steps = 1}, with_ceiling) == 1);
    CHECK(most({.sub_steps = 30, .stepping = Stepping::whole_step}, with_ceiling) == 30);
    CHECK(most({.sub_steps = 30, .first_regularization = 1.2f}, with_ceiling) == 30);
    CHECK(most({.sub_steps = 30}, {.positions_only = true, .limits_stretch = true}) == 30);
    CHECK(most({.sub_steps = 30, .most_sub_steps = 45}, with_ceiling) == 45);
    constexpr int greatest = std::numeric_limits<int>::max();
    CHECK(most({.sub_steps = greatest}, with_ceiling) == greatest);
}

TEST_CASE("sub-steps follow what a whole step would do, and what was asked for") {
    const Parameters parameters{.sub_steps = 10, .most_sub_steps = 40};
    CHECK(followed(parameters, 0.0, 0.0f) == 10);
    CHECK(followed(parameters, 2.2, 0.0f) == 10);   // 2.2 / 0.23 = 9.6
    CHECK(followed(parameters, 4.5, 0.0f) == 20);   // 19.6
    CHECK(followed(parameters, 4.5, 24.5f) == 25);  // the greater of both
    CHECK(followed(parameters, 1e300, 0.0f) == 40);
    CHECK(followed(parameters, 0.0, std::numeric_limits<float>::infinity()) == 40);
}

TEST_CASE("the next call is asked for as many sub-steps as bring the greatest mass to eight times the given") {
    // Added mass grows with the square of a sub-step.
    CHECK(next_asked_sub_steps(0.0f, 30, 8.0f) == 30.0f);
    CHECK(next_asked_sub_steps(0.0f, 30, 29.0f) == 60.0f);
    CHECK(next_asked_sub_steps(0.0f, 30, 1.0f) == 0.0f);
    CHECK(next_asked_sub_steps(100.0f, 30, 8.0f) == 80.0f);  // no faster down than to 0.8
}
