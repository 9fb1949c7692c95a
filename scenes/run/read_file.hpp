// SPDX-License-Identifier: MIT
#pragma once

#include "run/input_error.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

namespace apsl::scenes {

/// All bytes of a file. Throws InputError where there is none, where it is a folder or a device, or cannot be read.
inline std::string read_file(const std::filesystem::path& file, const std::string& kind) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) throw InputError(file.string() + ": no such " + kind + " file");
    if (!std::filesystem::is_regular_file(file, error))
        throw InputError(file.string() + ": is a folder or a device, expected a " + kind + " file");
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError(file.string() + ": cannot be opened for reading");
    return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace apsl::scenes
