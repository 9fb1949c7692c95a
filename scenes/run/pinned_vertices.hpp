// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"

#include <cstdint>
#include <vector>

namespace apsl::scenes {

/// Those without a weight, ascending; vertices in no triangle have none either.
inline std::vector<std::uint32_t> pinned_vertices(const ClothState& cloth) {
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t v = 0; v < cloth.inverse_masses.size(); ++v)
        if (cloth.inverse_masses[v] == 0.0) vertices.push_back(v);
    return vertices;
}

}  // namespace apsl::scenes
