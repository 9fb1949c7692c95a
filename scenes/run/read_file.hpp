// SPDX-License-Identifier: MIT
#pragma once

#include "run/input_error.hpp"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <ios>
#include <iterator>
#include <string>
#include <system_error>

namespace apsl::scenes {

/// All bytes of a file. Throws InputError where there is none, where it is a folder or a device, or cannot be read.
inline std::string read_file(const std::filesystem::path& file, const std::string& kind) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found)
        throw InputError(file.string() + ": no such " + kind + " file");
    if (error) throw InputError(file.string() + ": cannot be read: " + error.message());
    if (!std::filesystem::is_regular_file(status))
        throw InputError(file.string() + ": is a folder or a device, expected a " + kind + " file");
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError(file.string() + ": cannot be read: " + std::generic_category().message(errno));
    try {
        return {std::istreambuf_iterator<char>(stream), {}};
    } catch (const std::ios_base::failure& failure) {
        throw InputError(file.string() + ": reading failed: " + failure.code().message());
    }
}

}  // namespace apsl::scenes
