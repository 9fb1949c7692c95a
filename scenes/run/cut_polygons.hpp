// SPDX-License-Identifier: MIT
#pragma once

#include "run/mesh.hpp"
#include "run/polygon_mesh.hpp"

namespace apsl::scenes {

/// Cuts every face into triangles (see cut_polygon). A polygon that is closed by its first vertex, or that runs to a
/// vertex and straight back, is read without that; a face of which nothing is left then is left out, with a warning.
/// Throws InputError for a face that has no area otherwise, or that is too long to be cut.
Mesh cut_polygons(PolygonMesh polygons);

}  // namespace apsl::scenes
