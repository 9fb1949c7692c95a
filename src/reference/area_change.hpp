// SPDX-License-Identifier: MIT
#pragma once

#include "reference/geometry.hpp"

#include <span>

namespace apsl::reference {

/// |A − A⁰| / A⁰ over the triangles of a cloth.
struct AreaChange {
    double max;
    double rms;         ///< root of the mean of the squares, weighted with A⁰
    double capped_rms;  ///< the same with each triangle's counted as at most 1
    bool finite;        ///< every triangle's is; where not, max and rms mean nothing
};

/// geometry [T]; rest_areas in m², [T]; triangles without one have no say.
template <class Real>
AreaChange area_change(std::span<const TriangleGeometry<Real>> geometry, std::span<const Real> rest_areas);

}  // namespace apsl::reference
