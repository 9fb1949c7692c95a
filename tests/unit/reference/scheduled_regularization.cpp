// SPDX-License-Identifier: MIT
#include "scheduled_regularization.hpp"

#include <catch2/catch.hpp>

using namespace apsl;

TEST_CASE("scheduled alpha: geometric in alpha - 1, from the first sub-step to the last") {
    Parameters rising{.regularization = 1.5f, .sub_steps = 3, .first_regularization = 1.125f};
    CHECK(scheduled_regularization(1.5, rising, 0) == Approx(1.125));
    CHECK(scheduled_regularization(1.5, rising, 1) == Approx(1.25));
    CHECK(scheduled_regularization(1.5, rising, 2) == 1.5);
    rising.sub_steps = 5;
    CHECK(scheduled_regularization(1.5, rising, 1) == Approx(1.0 + 0.125 * std::sqrt(2.0)));
    const Parameters falling{.regularization = 1.25f, .sub_steps = 4, .first_regularization = 3.0f};
    CHECK(scheduled_regularization(1.25, falling, 0) == Approx(3.0));
    CHECK(scheduled_regularization(1.25, falling, 1) == Approx(2.0));
    CHECK(scheduled_regularization(1.25, falling, 2) == Approx(1.5));
    CHECK(scheduled_regularization(1.25, falling, 3) == 1.25);
}

TEST_CASE("scheduled alpha: one for each triangle is that of the last sub-step, scaled alike") {
    const Parameters parameters{.regularization = 1.5f, .sub_steps = 3, .first_regularization = 1.125f};
    CHECK(scheduled_regularization(3.0, parameters, 0) == Approx(1.5));
    CHECK(scheduled_regularization(3.0, parameters, 1) == Approx(2.0));
    CHECK(scheduled_regularization(1.0, parameters, 0) == 1.0);
}

TEST_CASE("scheduled alpha: as given without a schedule, and in a single sub-step") {
    CHECK(scheduled_regularization(1.2, Parameters{.sub_steps = 3}, 0) == 1.2);
    CHECK(scheduled_regularization(1.2, Parameters{.sub_steps = 1, .first_regularization = 1.01f}, 0) == 1.2);
}
