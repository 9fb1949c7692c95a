// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <string_view>

namespace apsl::scenes {

/// Objects and arrays within one another. What reads a scene further is recursive: more would use up the stack.
inline constexpr std::size_t max_scene_depth = 64;

/// JSON in UTF-8, with or without a byte order mark. Throws InputError, beginning with `name`, for what is no JSON (the
/// line is named), for a key that an object has twice, and for what is nested too deep for a scene.
nlohmann::ordered_json parse_json(std::string_view text, const std::string& name);

}  // namespace apsl::scenes
