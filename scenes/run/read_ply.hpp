// SPDX-License-Identifier: MIT
#pragma once

#include "run/polygon_mesh.hpp"

#include <string>
#include <string_view>

namespace apsl::scenes {

/// Stanford PLY 1.0, text or binary of either byte order: x, y, z of the vertices and the faces' vertex_indices (or
/// vertex_index); where there are no faces, the triangles of its tristrips, which −1 divides. Other elements and
/// properties are passed over. `file` is what errors name. Errors as in read_mesh.
PolygonMesh read_ply(std::string_view contents, const std::string& file);

}  // namespace apsl::scenes
