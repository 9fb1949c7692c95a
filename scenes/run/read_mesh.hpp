// SPDX-License-Identifier: MIT
#pragma once

#include "run/mesh.hpp"

#include <filesystem>
#include <optional>

namespace apsl::scenes {

struct MeshFile {
    std::filesystem::path file;    ///< .obj or .ply; relative to the scene file
    std::optional<double> height;  ///< m, > 0: scaled about the origin to this extent along y; as it is without
    double weld = 0.0;             ///< m, ≥ 0: vertices of the scaled mesh within this distance become one; 0: none do
};

/// Reads an .obj or .ply file. Vertices keep their order, and their numbers unless some are welded; faces become
/// triangles as cut_polygons says.
/// Throws InputError naming the file and the line (OBJ) or the vertex or face as PLY counts them, from 0: no such file,
/// not readable, no vertices or faces, a coordinate that is not a finite number, a face with fewer than three vertices,
/// with an index out of range or without an area, no extent along y to scale.
Mesh read_mesh(const MeshFile& source);

}  // namespace apsl::scenes
