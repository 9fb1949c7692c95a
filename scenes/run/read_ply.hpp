// SPDX-License-Identifier: MIT
#pragma once

#include "run/mesh.hpp"

#include <filesystem>

namespace apsl::scenes {

/// Stanford PLY, text or binary, through Assimp. Coordinates are rounded to 32-bit floats, which is what Assimp holds.
/// Errors as in read_mesh.
Mesh read_ply(const std::filesystem::path& file);

}  // namespace apsl::scenes
