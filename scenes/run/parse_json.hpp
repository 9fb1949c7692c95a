// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace apsl::scenes {

/// JSON in UTF-8, with or without a byte order mark. Throws InputError, beginning with `name`, for what is no JSON (the
/// line is named), for a key that an object has twice, and for what is nested too deep for a scene.
nlohmann::ordered_json parse_json(std::string_view text, const std::string& name);

}  // namespace apsl::scenes
