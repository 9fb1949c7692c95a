// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/topology.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace apsl::scenes {

/// What the stages of a step hand to one another. A vertex with inverse mass 0 is pinned: only Pins changes its
/// velocity.
struct ClothState {
    std::shared_ptr<const Topology> topology;
    std::vector<double> positions;       ///< m, [3V]
    std::vector<double> velocities;      ///< m/s, [3V]
    std::vector<double> masses;          ///< kg, [V], 0 for a vertex in no triangle
    std::vector<double> inverse_masses;  ///< 1/kg, [V], 0 for pinned vertices and for those in no triangle
    std::vector<double> rest_positions;  ///< m, [3V]
    std::vector<double> rest_areas;      ///< m², [T]
};

/// A cloth at rest at `rest_positions` (m, [3V]). Lumped masses: each vertex carries a third of the rest area of its
/// triangles times `density` (kg/m²). `pinned_vertices` may repeat itself.
/// Throws Error(invalid_argument): sizes that do not fit, a position that is not finite, density that is not positive
/// and finite, a pinned vertex out of range; Error(invalid_mesh): a vertex whose triangles have no area at all and so
/// no mass (pinned ones excepted).
ClothState make_cloth_state(std::shared_ptr<const Topology> topology, std::span<const double> rest_positions,
                            double density, std::span<const std::uint32_t> pinned_vertices);

}  // namespace apsl::scenes
