// SPDX-License-Identifier: MIT
#pragma once

#include "run/polygon_mesh.hpp"

#include <string>
#include <string_view>

namespace apsl::scenes {

/// The v and f lines of a Wavefront OBJ file; all others are passed over, and no other file is opened. A v or f line
/// goes on in the next one where it ends with a backslash. `file` is what errors name. Errors as in read_mesh.
PolygonMesh read_obj(std::string_view contents, const std::string& file);

}  // namespace apsl::scenes
