// SPDX-License-Identifier: MIT
#pragma once

#include "reference/conjugate_gradient.hpp"
#include "reference/geometry.hpp"

#include "../../kernels/constants.h"

#include <apsl/reference.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace apsl::reference {

/// 1 for a vertex at a triangle outside its limits, 0 for any other, [V]. A triangle is where its area change or its
/// stretch over the ceiling is above APSLK_UNMET at the end of a whole step, or was at its start. Areas at the start
/// are `rest_areas` + `start_error`, those at the end are in `geometry`; `excess(a)` is the greater of both ends', or
/// 0.
template <class Real, class Excess>
std::vector<std::uint8_t> unmet_vertices(const Topology& topology, std::span<const Real> rest_areas,
                                         const TriangleVector<Real>& start_error,
                                         std::span<const TriangleGeometry<Real>> geometry, const Excess& excess) {
    std::vector<std::uint8_t> unmet(topology.vertex_count(), 0);
    for (std::size_t a = 0; a < geometry.size(); ++a) {
        const Real rest_area = rest_areas[a];
        if (!(rest_area > Real(0))) continue;
        const Real change = std::max(std::abs(start_error[a]), std::abs(geometry[a].area - rest_area)) / rest_area;
        if (std::max(change, excess(a)) > Real{APSLK_UNMET})
            for (const std::uint32_t vertex : topology.triangles()[a]) unmet[vertex] = 1;
    }
    return unmet;
}

}  // namespace apsl::reference
