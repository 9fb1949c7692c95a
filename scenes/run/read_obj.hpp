// SPDX-License-Identifier: MIT
#pragma once

#include "run/mesh.hpp"

#include <filesystem>

namespace apsl::scenes {

/// Wavefront OBJ, through tinyobjloader. Errors as in read_mesh.
Mesh read_obj(const std::filesystem::path& file);

}  // namespace apsl::scenes
