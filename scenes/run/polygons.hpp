// SPDX-License-Identifier: MIT
#pragma once

#include "run/mesh.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace apsl::scenes {

/// Adds a polygon to the mesh as a fan from its first vertex. `file` and `face` are what errors name.
/// Throws InputError as read_mesh says.
void add_polygon(Mesh& mesh, std::span<const std::int64_t> vertices, const std::string& file, std::size_t face);

}  // namespace apsl::scenes
