// SPDX-License-Identifier: MIT
#include "run/whole_file.hpp"

#include "run/input_error.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>

namespace apsl::scenes {
namespace {

// Never put a file in the place of a device or a pipe, least of all as root.
void check_is_plain(const std::filesystem::path& place) {
    std::error_code error;
    const std::filesystem::file_type type = std::filesystem::status(place, error).type();
    if (type == std::filesystem::file_type::none)
        throw InputError(place.string() + ": cannot be written: " + error.message());
    if (type != std::filesystem::file_type::not_found && type != std::filesystem::file_type::regular)
        throw InputError(place.string() + ": exists and is no plain file, expected a place for one");
}

// Makes a file under a name that nothing there has, and takes it out again. `place` is for the message.
void check_writable(const std::filesystem::path& folder, const std::filesystem::path& place) {
    std::string probe = (folder / ".apsl_XXXXXX").string();
    const int descriptor = mkstemp(probe.data());
    if (descriptor < 0)
        throw InputError(place.string() + ": cannot be written: " + std::generic_category().message(errno) +
                         ", expected a writable folder");
    close(descriptor);
    unlink(probe.c_str());
}

}  // namespace

std::filesystem::path partial_file(const std::filesystem::path& place) {
    return place.string() + ".partial";
}

WholeFile::WholeFile(std::filesystem::path place) : place_(std::move(place)), temporary_(partial_file(place_)) {
    check_is_plain(place_);
    stream_.open(temporary_, std::ios::binary | std::ios::trunc);
    if (!stream_) throw InputError(place_.string() + ": cannot be written, expected a writable folder");
}

WholeFile::~WholeFile() {
    stream_.close();
    std::error_code ignored;  // after commit there is nothing to remove
    std::filesystem::remove(temporary_, ignored);
}

void WholeFile::write(std::string_view bytes) {
    stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    check();
}

void WholeFile::overwrite(std::int64_t offset, std::string_view bytes) {
    stream_.seekp(offset);
    write(bytes);
    stream_.seekp(0, std::ios::end);
}

void WholeFile::commit() {
    stream_.close();
    check();
    std::error_code error;
    std::filesystem::rename(temporary_, place_, error);
    if (error) throw InputError(place_.string() + ": cannot be written: " + error.message());
}

void WholeFile::check() const {
    if (!stream_) throw InputError(place_.string() + ": writing failed, is the disk full?");
}

void check_file_place(const std::filesystem::path& file) {
    if (!file.has_filename()) throw InputError("\"" + file.string() + "\": expected the name of a file");
    std::error_code not_there;
    if (!file.parent_path().empty() && !std::filesystem::is_directory(file.parent_path(), not_there))
        throw InputError(file.string() + ": no such folder, expected one that the file can be written to");
    check_is_plain(file);
    check_writable(file.parent_path(), file);
}

void make_writable_folder(const std::filesystem::path& folder) {
    if (folder.empty()) throw InputError("\"\": expected the name of a folder");
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || !std::filesystem::is_directory(folder, error))
        throw InputError(folder.string() + ": cannot be made a folder" + (error ? ": " + error.message() : ""));
    check_writable(folder, folder);
}

}  // namespace apsl::scenes
