// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace apsl::scenes {

/// A file that is either whole or not there: written beside its place under another name, and moved there by commit.
/// Without commit nothing stays. Throws InputError where the file cannot be made or written.
class WholeFile {
public:
    explicit WholeFile(std::filesystem::path place);
    ~WholeFile();
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    void write(std::string_view bytes);
    template <class Value>
    void write_value(const Value& value) {
        write({reinterpret_cast<const char*>(&value), sizeof value});
    }
    /// Overwrites bytes written before, counted from the start of the file.
    void overwrite(std::int64_t offset, std::string_view bytes);
    void commit();

private:
    void check() const;

    std::filesystem::path place_;
    std::filesystem::path temporary_;
    std::ofstream stream_;
};

/// Where a file for `place` is written before it is whole.
std::filesystem::path partial_file(const std::filesystem::path& place);

/// What cannot be written should be known before the work, not after it. Throws InputError where no file can be made
/// at `file`.
void check_file_place(const std::filesystem::path& file);

/// Makes the folder and what it lies in. Throws InputError where that fails or where no file can be made in it.
void make_writable_folder(const std::filesystem::path& folder);

}  // namespace apsl::scenes
