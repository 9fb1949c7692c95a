// SPDX-License-Identifier: MIT
#include "methods/edge_constraints.hpp"

namespace apsl::methods {

std::vector<EdgeConstraint> edge_constraints(const Cloth& cloth) {
    std::vector<EdgeConstraint> constraints;
    constraints.reserve(cloth.topology->edges().size());
    for (const auto& [a, b] : cloth.topology->edges()) {
        const double wa = cloth.inverse_masses[a];
        const double wb = cloth.inverse_masses[b];
        if (wa == 0.0 && wb == 0.0) continue;
        constraints.push_back({{a, b},
                               {static_cast<float>(wa), static_cast<float>(wb)},
                               static_cast<float>((cloth.rest_positions[b] - cloth.rest_positions[a]).norm())});
    }
    return constraints;
}

}  // namespace apsl::methods
