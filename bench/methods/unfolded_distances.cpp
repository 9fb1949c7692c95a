// SPDX-License-Identifier: MIT
#include "methods/unfolded_distances.hpp"

#include "ways_to_pins.hpp"

#include <span>

namespace apsl::methods {

std::vector<std::vector<PinDistance>> unfolded_distances(const Cloth& cloth) {
    std::vector<std::uint32_t> pinned;
    std::vector<double> positions;
    for (std::uint32_t v = 0; v < cloth.rest_positions.size(); ++v) {
        if (cloth.inverse_masses[v] == 0.0) pinned.push_back(v);
        positions.insert(positions.end(), cloth.rest_positions[v].begin(), cloth.rest_positions[v].end());
    }
    const PinnedPieces islands = pinned_pieces(*cloth.topology, pinned);
    std::vector<std::vector<PinDistance>> distances(islands.count);
    WaysToPins ways(*cloth.topology, positions, islands.count);
    for (const std::vector<Way>& found : ways.find(islands))
        for (const Way& way : found)
            if (cloth.inverse_masses[way.vertex] > 0.0)
                distances[way.piece].push_back({way.vertex, way.anchor, way.length});
    return distances;
}

}  // namespace apsl::methods
