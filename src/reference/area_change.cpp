// SPDX-License-Identifier: MIT
#include "reference/area_change.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace apsl::reference {

template <class Real>
AreaChange area_change(std::span<const TriangleGeometry<Real>> geometry, std::span<const Real> rest_areas) {
    double max = 0.0;
    double sum_of_squares = 0.0;
    bool finite = true;
    constexpr double greatest = std::numeric_limits<float>::max();  // Stats are 32-bit
    for (std::size_t a = 0; a < geometry.size(); ++a) {
        const double change = static_cast<double>(std::abs(geometry[a].area - rest_areas[a]) / rest_areas[a]);
        finite = finite && change <= greatest;  // false for NaN too
        max = std::max(max, change);
        sum_of_squares += change * change;
    }
    return {max, std::sqrt(sum_of_squares / static_cast<double>(geometry.size())), finite};
}

template AreaChange area_change(std::span<const TriangleGeometry<double>>, std::span<const double>);
template AreaChange area_change(std::span<const TriangleGeometry<float>>, std::span<const float>);

}  // namespace apsl::reference
