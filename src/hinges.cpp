// SPDX-License-Identifier: MIT
#include <apsl/topology.hpp>

namespace apsl {

std::vector<Hinge> Topology::hinges() const {
    std::vector<Hinge> hinges;
    hinges.reserve(hinge_count());
    for (std::size_t e = 0; e < edges_.size(); ++e) {
        const std::uint32_t first = edge_corner_offsets_[e];
        if (edge_corner_offsets_[e + 1] - first != 2) continue;
        const auto opposite = [&](std::uint32_t n) {
            const Corner corner = edge_corners_[n];
            return triangles_[corner / 3][corner % 3];
        };
        hinges.push_back({edges_[e][0], edges_[e][1], opposite(first), opposite(first + 1)});
    }
    return hinges;
}

}  // namespace apsl
