// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace apsl::scenes {

/// Shortest over longest edge below which a triangle counts as a needle. A hanging sheet of 33 × 33 vertices with one
/// edge of 1/50 of its neighbours keeps areas within 3 % and a ceiling of 1.1 within 0.02; with one of 1/170 9 % and
/// 0.25.
inline constexpr double needle_edge = 1.0 / 100.0;

/// Triangles with one edge much shorter than the others, at rest. Across it a small displacement is a great stretch,
/// whatever the vertices weigh, and more sub-steps hardly help.
struct NeedleTriangles {
    std::size_t count = 0;
    std::uint32_t sharpest = 0;
    double shortest_over_longest = 1.0;   ///< edge, of the sharpest
    std::optional<double> weld_distance;  ///< m: joins the ends of all short edges, and of no edge of another triangle,
                                          ///< of which there are some
};

NeedleTriangles needle_triangles(const ClothState& cloth);

/// What to tell of needles at set-up; nothing where there are none. `from_file`: a scene may weld the mesh.
std::optional<std::string> needle_triangles_warning(const NeedleTriangles& needles, bool from_file);

}  // namespace apsl::scenes
