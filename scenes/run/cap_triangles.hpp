// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace apsl::scenes {

/// Height over longest edge below which a triangle without a short edge counts as a cap.
inline constexpr double cap_height = 1.0 / 50.0;

/// Triangles with a corner close to the opposite edge, at rest. A small displacement of that corner is a large share of
/// their area, whatever the vertices weigh.
struct CapTriangles {
    std::size_t count = 0;
    std::uint32_t flattest = 0;
    double height = 1.0;  ///< of the flattest, over its longest edge
};

CapTriangles cap_triangles(const ClothState& cloth);

/// "flip the longest edge of triangle 7 and of those like it".
std::string cap_triangles_advice(const CapTriangles& caps);

/// What to tell of caps at set-up; nothing where there are none.
std::optional<std::string> cap_triangles_warning(const CapTriangles& caps);

}  // namespace apsl::scenes
