// SPDX-License-Identifier: MIT
#include "fields.hpp"
#include "finite.hpp"
#include "invalid.hpp"
#include "ways_to_pins.hpp"

#include <apsl/tethers.hpp>

#include <cstddef>
#include <limits>
#include <string>

namespace apsl {

std::size_t pinned_piece_count(const Topology& topology, std::span<const std::uint32_t> pinned) {
    return pinned_pieces(topology, pinned).count;
}

Tethers tethers_to_pins(const Topology& topology, std::span<const float> rest_positions,
                        std::span<const std::uint32_t> pinned, std::uint32_t per_vertex, float stretch) {
    if (rest_positions.size() != 3 * topology.vertex_count())
        invalid("rest_positions holds " + std::to_string(rest_positions.size()) + " numbers, expected " +
                std::to_string(3 * topology.vertex_count()));
    for (std::size_t n = 0; n < rest_positions.size(); ++n)
        if (!is_finite(rest_positions[n]))
            invalid("rest_positions of vertex " + std::to_string(n / 3) +
                    " is not finite, expected finite numbers (m)");
    if (per_vertex == 0 || per_vertex > most_tethers)
        invalid("per_vertex is " + std::to_string(per_vertex) + ", expected a whole number from 1 to " +
                std::to_string(most_tethers));
    if (!is_finite(stretch) || !(stretch > 0.0f))
        invalid("stretch is " + std::to_string(stretch) + ", expected a finite number > 0");

    const PinnedPieces pieces = pinned_pieces(topology, pinned);
    const std::vector<double> positions(rest_positions.begin(), rest_positions.end());
    WaysToPins ways(topology, positions, per_vertex);
    const std::vector<std::vector<Way>>& found = ways.find(pieces);
    const std::size_t count = per_vertex * topology.vertex_count();
    Tethers tethers{std::vector<std::uint32_t>(count, 0), std::vector<float>(count, 0.0f)};
    for (std::size_t v = 0; v < found.size(); ++v) {
        if (pieces.of_vertex[v] != PinnedPieces::none) continue;
        for (std::size_t k = 0; k < found[v].size(); ++k) {
            tethers.anchors[per_vertex * v + k] = found[v][k].anchor;
            // A way that no float holds is no tether.
            const double length = static_cast<double>(stretch) * found[v][k].length;
            if (length <= static_cast<double>(std::numeric_limits<float>::max()))
                tethers.lengths[per_vertex * v + k] = static_cast<float>(length);
        }
    }
    return tethers;
}

}  // namespace apsl
