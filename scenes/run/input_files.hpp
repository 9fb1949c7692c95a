// SPDX-License-Identifier: MIT
#pragma once

#include "run/scene.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace apsl::scenes {

/// A file that a command reads, and that is the user's to keep.
struct InputFile {
    std::string what;  ///< "the scene", for messages
    std::filesystem::path file;
};

/// The scene's own file, and that of its mesh where it has one.
std::vector<InputFile> input_files(const Scene& scene);

/// Throws InputError naming both where a file written at `output` would take the place of an input, whatever names and
/// links lead to it.
void check_not_an_input(const std::filesystem::path& output, std::span<const InputFile> inputs);

}  // namespace apsl::scenes
