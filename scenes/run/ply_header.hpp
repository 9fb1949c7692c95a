// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace apsl::scenes {

enum class PlyFormat { ascii, binary_little_endian, binary_big_endian };

/// A number's type by its size in bytes: 1, 2, 4 or 8 where it is whole, 4 or 8 where not.
struct PlyType {
    std::size_t size;
    bool is_float, is_signed;
};

struct PlyProperty {
    std::string name;
    PlyType type;
    std::optional<PlyType> count;  ///< the type of a list's length, where it is a list
};

struct PlyElement {
    std::string name;
    std::uint64_t count;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyFormat format;
    std::vector<PlyElement> elements;
};

/// Takes the header off the contents: from `ply` to the line end behind `end_header`. `file` is what errors name.
/// Throws InputError for what is no PLY header.
PlyHeader take_ply_header(std::string_view& contents, const std::string& file);

/// Throws InputError(file: not a readable PLY mesh: what).
[[noreturn]] void refuse_ply(const std::string& file, const std::string& what);

}  // namespace apsl::scenes
