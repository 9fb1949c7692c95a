// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace apsl::bench {

/// First quartile, median and third quartile, interpolated; zeros where there are no samples.
struct Quartiles {
    double first = 0.0;
    double median = 0.0;
    double third = 0.0;
};
Quartiles quartiles(std::vector<double> samples);

}  // namespace apsl::bench
