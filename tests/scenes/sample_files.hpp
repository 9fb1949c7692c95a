// SPDX-License-Identifier: MIT
#pragma once

#include "run/input_error.hpp"

#include <filesystem>
#include <string>

namespace apsl::test {

/// A folder of its own for each test, gone at its end.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    /// Writes a file and returns its path.
    std::string write(const std::string& name, const std::string& contents) const;

private:
    std::filesystem::path path_;
};

std::string read_bytes(const std::filesystem::path& file);

/// A PLY file in text with these vertices and faces, one a line.
std::string ply_text(int vertices, int faces, const std::string& lines);

/// The message of the InputError that `action` throws; empty where it throws none.
template <class Action>
std::string input_error_of(const Action& action) {
    try {
        action();
    } catch (const scenes::InputError& error) {
        return error.what();
    }
    return {};
}

}  // namespace apsl::test
