// SPDX-License-Identifier: MIT
#include "host/queued_iterations.hpp"

#include <catch2/catch.hpp>

using namespace apsl;
using namespace apsl::host;

namespace {

constexpr std::size_t small_cloth = 20'000, large_cloth = 200'000;

int queued(const Parameters& parameters, std::size_t largest = small_cloth, int sub_step = 0) {
    CallBudget budget;
    budget.add(parameters);
    return queued_iterations(largest, budget, sub_step);
}

}  // namespace

TEST_CASE("queued iterations: what α and the tolerance make likely, even, at most max_iterations", "[filter]") {
    CHECK(queued({}) == 8);
    CHECK(queued({.regularization = 1.2f, .sub_steps = 10}) == 8);
    // ½ √κ ln(2 √κ / tolerance), κ = (α + 2) / (α − 1) = 301: 50.8, for small cloths half of it.
    const Parameters low{.regularization = 1.01f, .sub_steps = 10, .tolerance = 0.1f, .max_iterations = 100};
    CHECK(queued(low) == 26);
    CHECK(queued(low, large_cloth) == 52);
    Parameters few = low;
    few.max_iterations = 7;
    CHECK(queued(few) == 7);
    CHECK(queued(few, large_cloth) == 7);
}

TEST_CASE("queued iterations: each sub-step's own α", "[filter]") {
    const Parameters rising{.regularization = 1.2f,
                            .sub_steps = 3,
                            .tolerance = 0.1f,
                            .max_iterations = 100,
                            .first_regularization = 1.01f};
    CHECK(queued(rising, small_cloth, 0) == 26);
    CHECK(queued(rising, small_cloth, 1) < 26);
    CHECK(queued(rising, small_cloth, 2) == 8);
}

TEST_CASE("queued iterations: all of them where nothing bounds a solve", "[filter]") {
    CHECK(queued({.regularization = 1.0f}) == 50);
    CHECK(queued({.tolerance = 0.0f}) == 50);
}

TEST_CASE("queued iterations: the hardest of several cloths decides", "[filter]") {
    CallBudget budget;
    budget.add(Parameters{.regularization = 1.2f, .sub_steps = 4, .tolerance = 0.1f, .max_iterations = 60});
    budget.add(Parameters{.regularization = 1.01f, .sub_steps = 2, .tolerance = 0.5f, .max_iterations = 100});
    CHECK(budget.sub_steps == 4);
    CHECK(budget.max_iterations == 100);
    CHECK(queued_iterations(small_cloth, budget, 0) == 26);
}
