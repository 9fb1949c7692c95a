// SPDX-License-Identifier: MIT
#pragma once

#include "run/mesh.hpp"

#include <string>
#include <string_view>

namespace apsl::scenes {

/// The v and f lines of a Wavefront OBJ file; all others are passed over, and no other file is opened.
/// `file` is what errors name. Errors as in read_mesh.
Mesh read_obj(std::string_view contents, const std::string& file);

}  // namespace apsl::scenes
