// SPDX-License-Identifier: MIT
#pragma once

#include "filter/filtered.hpp"

#include <vector>

namespace apsl::test {

/// Where a whole step ends (Options::integrates).
struct Ended {
    std::vector<double> positions, velocities;
    Stats stats;
};

Ended step_on_device(StrainLimiter& limiter, const MovingCloth& cloth, const Options& options,
                     const Parameters& parameters);
/// The same in a limiter of its own.
Ended step_on_device(const MovingCloth& cloth, const Options& options, const Parameters& parameters);
Ended step_with_reference(const MovingCloth& cloth, const Options& options, const Parameters& parameters);

/// Checks that a whole step leaves the same bytes twice, and in every layout of positions and velocities, and writes to
/// no input.
void check_step_in_every_layout(const MovingCloth& cloth, const Options& options, const Parameters& parameters);

/// Checks that in one limiter the cloths end a whole step where they do in limiters of their own.
void check_step_as_alone(const std::vector<MovingCloth>& cloths, const Options& options, const Parameters& parameters);

/// These options with vectors of more numbers than three, and with x, y and z of all vertices apart.
std::vector<Options> strided_and_apart(const Options& options);

struct BothEnds {
    Ended got, want;
};

/// Checks that a whole step on the device ends where the reference has it end; both ends, for more checks.
BothEnds check_step_against_reference(const MovingCloth& cloth, const Options& options, const Parameters& parameters);

}  // namespace apsl::test
