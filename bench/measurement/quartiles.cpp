// SPDX-License-Identifier: MIT
#include "measurement/quartiles.hpp"

#include <algorithm>
#include <cstddef>

namespace apsl::bench {

Quartiles quartiles(std::vector<double> samples) {
    if (samples.empty()) return {};
    std::sort(samples.begin(), samples.end());
    const auto quantile = [&](double fraction) {
        const double place = fraction * static_cast<double>(samples.size() - 1);
        const auto below = static_cast<std::size_t>(place);
        const std::size_t above = std::min(below + 1, samples.size() - 1);
        const double weight = place - static_cast<double>(below);
        return (1.0 - weight) * samples[below] + weight * samples[above];
    };
    return {quantile(0.25), quantile(0.5), quantile(0.75)};
}

}  // namespace apsl::bench
