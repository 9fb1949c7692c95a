// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace apsl::scenes {

/// A scene as people write it: keys in their order, and what fits into a line of 120 characters in one line. Ends with
/// a line feed.
std::string scene_text(const nlohmann::ordered_json& document);

}  // namespace apsl::scenes
