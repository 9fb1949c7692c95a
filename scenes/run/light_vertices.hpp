// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace apsl::scenes {

/// Share of the median mass below which a movable vertex counts as light.
inline constexpr double light_mass_ratio = 1.0 / 30.0;

/// Movable vertices that are too light for the forces that their neighbours pass on.
struct LightVertices {
    std::size_t count = 0;               ///< below light_mass_ratio times the median
    std::uint32_t lightest = 0;          ///< the movable vertex with the least mass, light or not
    double share_of_median = 1.0;        ///< its mass over the median, both of movable vertices
    std::optional<double> shorter_than;  ///< m: collapsing edges below this length removes light vertices
};

LightVertices light_vertices(const ClothState& cloth);

/// "vertex 18, 1/380 of the median mass".
std::string lightest_text(const LightVertices& light);

/// "collapse edges under 0.4 mm, or give them more mass".
std::string light_vertices_advice(const LightVertices& light);

/// What to tell of light vertices at set-up; nothing where there are none.
std::optional<std::string> light_vertices_warning(const LightVertices& light);

}  // namespace apsl::scenes
