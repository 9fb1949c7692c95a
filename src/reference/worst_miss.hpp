// SPDX-License-Identifier: MIT
#pragma once

#include "reference/conjugate_gradient.hpp"
#include "reference/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace apsl::reference {

/// By how much the triangle that is furthest from its limits misses them: the greatest area change, or stretch over the
/// ceiling, at the end of a whole step or at its start. Areas at the start are `rest_areas` + `start_error`, those at
/// the end are in `geometry`; `excess(a)` is the greater of both ends', or 0.
template <class Real, class Excess>
double worst_miss(std::span<const Real> rest_areas, const TriangleVector<Real>& start_error,
                  std::span<const TriangleGeometry<Real>> geometry, const Excess& excess) {
    Real worst(0);
    for (std::size_t a = 0; a < geometry.size(); ++a) {
        const Real rest_area = rest_areas[a];
        if (!(rest_area > Real(0))) continue;
        const Real change = std::max(std::abs(start_error[a]), std::abs(geometry[a].area - rest_area)) / rest_area;
        worst = std::max({worst, change, excess(a)});
    }
    return static_cast<double>(worst);
}

}  // namespace apsl::reference
