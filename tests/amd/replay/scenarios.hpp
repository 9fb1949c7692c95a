// SPDX-License-Identifier: MIT
#pragma once

#include "support/device_cloth.hpp"

#include <apsl/options.hpp>
#include <apsl/parameters.hpp>

#include <string>
#include <vector>

namespace apsl::test {

/// A limiter and what is asked of it.
struct Scenario {
    std::string name;
    Options options;
    std::vector<Parameters> parameters;  ///< one entry for all cloths, or one for each
    std::vector<MovingCloth> cloths;
    int calls = 1;
};

/// What `ctest` executes: between them every kernel and every option of it that a GPU gets.
std::vector<Scenario> small_scenarios();

/// More than that: cloths that give every work-item of a group work, and input that no solve can do right.
std::vector<Scenario> further_scenarios();

}  // namespace apsl::test
