// SPDX-License-Identifier: MIT
#include "run/scene_tethers.hpp"

#include "fields.hpp"
#include "run/opencl_cloth.hpp"
#include "run/pinned_vertices.hpp"

#include <apsl/reference.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace apsl::scenes {
namespace {

// Of the areas that the limiter is to hold to those of the mesh, as a factor of lengths.
double rest_length_factor(const ClothState& cloth) {
    const std::vector<double> areas = reference::areas<double>(*cloth.topology, cloth.rest_positions);
    const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
    return area > 0.0 ? std::sqrt(std::accumulate(cloth.rest_areas.begin(), cloth.rest_areas.end(), 0.0) / area) : 1.0;
}

}  // namespace

std::uint32_t tethers_per_vertex(const ClothState& cloth) {
    const std::size_t pieces = pinned_piece_count(*cloth.topology, pinned_vertices(cloth));
    return static_cast<std::uint32_t>(std::min(pieces, std::size_t{most_tethers}));
}

Tethers scene_tethers(const ClothState& cloth, const StrainLimiting& settings) {
    // Differences alone count, which 32 bits hold badly far from the origin.
    const std::vector<float> rest_positions = to_float_around(origin_for(cloth.rest_positions), cloth.rest_positions);
    const auto stretch = static_cast<float>(rest_length_factor(cloth) * static_cast<double>(settings.tethers));
    return tethers_to_pins(*cloth.topology, rest_positions, pinned_vertices(cloth), settings.options.tethers_per_vertex,
                           stretch);
}

}  // namespace apsl::scenes
