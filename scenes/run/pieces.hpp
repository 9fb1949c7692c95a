// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace apsl::scenes {

/// What of a cloth hangs together.
struct Pieces {
    std::size_t count = 0;        ///< of triangles that share vertices, one after the other
    std::size_t without_pin = 0;  ///< of these
};

Pieces pieces_of(const ClothState& cloth);

/// What to tell of vertices that lie in one place at rest, with triangles of their own: nearly always a mesh that was
/// written triangle by triangle, or a seam, which looks whole and comes apart. Nothing where there are none.
std::optional<std::string> coincidence_warning(const ClothState& cloth, const Pieces& pieces);

}  // namespace apsl::scenes
