// SPDX-License-Identifier: MIT
#include "reference/area_change.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace apsl::reference {

template <class Real>
AreaChange area_change(std::span<const TriangleGeometry<Real>> geometry, std::span<const Real> rest_areas) {
    double max = 0.0;
    double weighted_squares = 0.0;
    double capped_squares = 0.0;
    double weights = 0.0;
    bool finite = true;
    constexpr double greatest = std::numeric_limits<float>::max();  // Stats are 32-bit, and so is what they are made of
    for (std::size_t a = 0; a < geometry.size(); ++a) {
        const auto rest_area = static_cast<double>(rest_areas[a]);
        if (rest_area == 0.0) continue;
        const double change = static_cast<double>(std::abs(geometry[a].area - rest_areas[a]) / rest_areas[a]);
        finite = finite && change * change <= greatest;  // false for NaN too
        max = std::max(max, change);
        weighted_squares += rest_area * change * change;
        const double capped = std::min(change, 1.0);
        capped_squares += rest_area * capped * capped;
        weights += rest_area;
    }
    const auto root_mean = [&](double squares) { return weights > 0.0 ? std::sqrt(squares / weights) : 0.0; };
    return {max, root_mean(weighted_squares), root_mean(capped_squares), finite};
}

template AreaChange area_change(std::span<const TriangleGeometry<double>>, std::span<const double>);
template AreaChange area_change(std::span<const TriangleGeometry<float>>, std::span<const float>);

}  // namespace apsl::reference
