// SPDX-License-Identifier: MIT
#pragma once

#include "run/mesh.hpp"

#include <filesystem>
#include <optional>

namespace apsl::scenes {

/// Reads an .obj or .ply file. Vertices keep their order and number; polygons are cut into a fan from their first
/// vertex. `height`: m, > 0; the mesh is scaled about the origin so that its extent along y is this.
/// Throws InputError naming the file and the line, vertex or face (counted from 0, as pins count vertices): no such
/// file, not readable, no vertices or faces, a coordinate that is not a finite number, a face with fewer than three
/// vertices, with one of them twice or with an index out of range, no extent along y to scale.
Mesh read_mesh(const std::filesystem::path& file, std::optional<double> height);

}  // namespace apsl::scenes
