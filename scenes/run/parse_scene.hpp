// SPDX-License-Identifier: MIT
#pragma once

#include "run/scene.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace apsl::scenes {

/// The scene that a JSON document describes; docs/scene.schema.json is the same in another tongue. Every key but `mesh`
/// has a default. Mesh paths are relative to the folder of `file`, which is also what messages name.
/// Throws InputError naming the file, the path of the key and what was expected there: unknown keys, values of another
/// type or out of range.
Scene parse_scene(const nlohmann::json& document, const std::string& file);

/// A scene file's values in the order of the file, changed by `overrides` (see override_scene.hpp), not looked at
/// further. Throws InputError for a file that is missing or no JSON (naming the line), or overrides that do not fit.
nlohmann::ordered_json read_scene_document(const std::filesystem::path& file,
                                           std::span<const std::string> overrides = {});

/// Reads a scene file, changes it by `overrides` (see override_scene.hpp) and parses it.
/// Throws InputError, also for a file that is missing or no JSON (naming the line).
Scene read_scene(const std::filesystem::path& file, std::span<const std::string> overrides = {});

}  // namespace apsl::scenes
