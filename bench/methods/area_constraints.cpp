// SPDX-License-Identifier: MIT
#include "methods/area_constraints.hpp"

#include <algorithm>

namespace apsl::methods {

std::vector<AreaConstraint> area_constraints(const Cloth& cloth) {
    std::vector<AreaConstraint> constraints;
    constraints.reserve(cloth.topology->triangle_count());
    for (std::size_t a = 0; a < cloth.topology->triangle_count(); ++a) {
        AreaConstraint constraint{cloth.topology->triangles()[a], {}, static_cast<float>(cloth.rest_areas[a])};
        std::ranges::transform(constraint.vertices, constraint.inverse_masses.begin(),
                               [&](std::uint32_t v) { return static_cast<float>(cloth.inverse_masses[v]); });
        if (std::ranges::any_of(constraint.inverse_masses, [](float w) { return w > 0.0f; }))
            constraints.push_back(constraint);
    }
    return constraints;
}

}  // namespace apsl::methods
