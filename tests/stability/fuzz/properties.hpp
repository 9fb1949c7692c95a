// SPDX-License-Identifier: MIT
#pragma once

#include "stability/fuzz/call_facts.hpp"

#include <optional>
#include <string>

namespace apsl::test {

/// A property that does not hold: its name, and figures.
struct Violation {
    std::string property, details;
};

/// What must hold after any call on any cloth. docs/formulation.md says why; the bounds are derived in the code.
std::optional<Violation> violation_of(const MovingCloth& cloth, const Options& options, const Parameters& parameters,
                                      const Filtered& filtered, const FuzzedFilter& filter);

/// What must hold between device and reference after the first call, where small errors stay small.
std::optional<Violation> disagreement(const MovingCloth& cloth, const Options& options, const Parameters& parameters,
                                      const Filtered& device, const Filtered& reference);

/// Equal bits.
bool same_velocities(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace apsl::test
