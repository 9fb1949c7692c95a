// SPDX-License-Identifier: MIT
#include "methods/edge_constraints.hpp"

namespace apsl::methods {

std::vector<EdgeConstraint> distance_constraints(const Cloth& cloth, std::span<const VertexPair> pairs) {
    std::vector<EdgeConstraint> constraints;
    constraints.reserve(pairs.size());
    for (const auto& [a, b] : pairs) {
        const double wa = cloth.inverse_masses[a];
        const double wb = cloth.inverse_masses[b];
        if (wa == 0.0 && wb == 0.0) continue;
        constraints.push_back({{a, b},
                               {static_cast<float>(wa), static_cast<float>(wb)},
                               static_cast<float>((cloth.rest_positions[b] - cloth.rest_positions[a]).norm())});
    }
    return constraints;
}

std::vector<EdgeConstraint> edge_constraints(const Cloth& cloth) {
    return distance_constraints(cloth, cloth.topology->edges());
}

}  // namespace apsl::methods
