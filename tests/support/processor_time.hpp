// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <ctime>

namespace apsl::test {

/// Processor time of this process that an action takes, s: the least of three, since a cache may be cold. Not the time
/// of day, which whatever else the machine does would change.
template <class Action>
double processor_seconds(const Action& action) {
    double least = 0.0;
    for (int attempt = 0; attempt < 3; ++attempt) {
        const std::clock_t start = std::clock();
        action();
        const double taken = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        least = attempt == 0 ? taken : std::min(least, taken);
    }
    return least;
}

}  // namespace apsl::test
