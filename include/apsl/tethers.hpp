// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/cxx20.hpp>
#include <apsl/export.hpp>
#include <apsl/topology.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace apsl {

/// Buffers::tether_anchors and tether_lengths of one cloth: those of vertex v begin at Options::tethers_per_vertex · v.
struct Tethers {
    std::vector<std::uint32_t> anchors;  ///< pinned vertices of this cloth
    std::vector<float> lengths;          ///< m; 0: no tether
};

/// Pieces of the mesh that are pinned: sets of pinned vertices that edges connect. A vertex wants a tether to each.
APSL_API std::size_t pinned_piece_count(const Topology& topology, std::span<const std::uint32_t> pinned);

/// Tethers of every vertex that is not pinned to the nearest pinned vertex of each of the `per_vertex` nearest pinned
/// pieces, as long as the way there over the surface at rest times `stretch`. Ways go straight across well-shaped
/// triangles, and are longer over obtuse ones; over a flat mesh they are never too short. With several cloths in the
/// buffers, add to the anchors what the vertices before them count. None, of length 0, where a vertex lies at its pin,
/// or further off than a float tells.
///
/// `rest_positions`: m, [3V]. `pinned`: vertices, in any order. Takes about per_vertex · V log V.
/// Throws Error(invalid_argument): sizes that do not fit, a position that is not finite, a pinned vertex ≥ V,
/// per_vertex 0 or above 4, a stretch that is not a finite number > 0.
APSL_API Tethers tethers_to_pins(const Topology& topology, std::span<const float> rest_positions,
                                 std::span<const std::uint32_t> pinned, std::uint32_t per_vertex, float stretch = 1.0f);

}  // namespace apsl
