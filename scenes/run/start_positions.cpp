// SPDX-License-Identifier: MIT
#include "run/start_positions.hpp"

#include "run/fixed_sequence.hpp"

#include <array>

namespace apsl::scenes {

void set_start_positions(const Start& start, ClothState& cloth) {
    if (start.scale == Start{}.scale && start.random == 0.0) return;  // bit for bit at rest
    const std::size_t vertex_count = cloth.inverse_masses.size();
    std::array<double, 3> center{};
    for (std::size_t i = 0; i < cloth.rest_positions.size(); ++i)
        center[i % 3] += cloth.rest_positions[i] / static_cast<double>(vertex_count);
    FixedSequence sequence;
    for (std::size_t i = 0; i < cloth.positions.size(); ++i) {
        const double aside = start.random * sequence.symmetric();
        if (cloth.inverse_masses[i / 3] == 0.0) continue;
        const std::size_t axis = i % 3;
        cloth.positions[i] = center[axis] + start.scale[axis] * (cloth.rest_positions[i] - center[axis]) + aside;
    }
}

}  // namespace apsl::scenes
