// SPDX-License-Identifier: MIT
#include "run/ply_header.hpp"

#include "run/input_error.hpp"
#include "run/words.hpp"

#include <utility>

namespace apsl::scenes {
namespace {

struct NamedType {
    std::string_view name, name_with_size;
    PlyType type;
};

constexpr NamedType types[] = {
    {"char", "int8", {1, false, true}},    {"uchar", "uint8", {1, false, false}},
    {"short", "int16", {2, false, true}},  {"ushort", "uint16", {2, false, false}},
    {"int", "int32", {4, false, true}},    {"uint", "uint32", {4, false, false}},
    {"long", "int64", {8, false, true}},   {"ulong", "uint64", {8, false, false}},
    {"float", "float32", {4, true, true}}, {"double", "float64", {8, true, true}},
};

std::optional<PlyType> type_named(std::string_view name) {
    for (const NamedType& known : types)
        if (name == known.name || name == known.name_with_size) return known.type;
    return {};
}

std::optional<PlyFormat> format_named(std::string_view name) {
    if (name == "ascii") return PlyFormat::ascii;
    if (name == "binary_little_endian") return PlyFormat::binary_little_endian;
    if (name == "binary_big_endian") return PlyFormat::binary_big_endian;
    return {};
}

/// What stands behind "property".
std::optional<PlyProperty> parse_property(std::string_view rest) {
    PlyProperty property;
    std::string_view word = take_word(rest);
    if (word == "list") {
        property.count = type_named(take_word(rest));
        if (!property.count || property.count->is_float) return {};
        word = take_word(rest);
    }
    const std::optional<PlyType> type = type_named(word);
    property.name = take_word(rest);
    if (!type || property.name.empty()) return {};
    property.type = *type;
    return property;
}

}  // namespace

void refuse_ply(const std::string& file, const std::string& what) {
    throw InputError(file + ": not a readable PLY mesh: " + what);
}

PlyHeader take_ply_header(std::string_view& contents, const std::string& file) {
    PlyHeader header;
    std::optional<PlyFormat> format;
    const std::string_view whole = contents;
    std::string_view first = take_line(contents);
    // Where lines end with \r alone, a \n behind the last one belongs to the numbers.
    const bool ends_with_return =
        whole.substr(first.size(), 2).starts_with('\r') && !whole.substr(first.size(), 2).ends_with('\n');
    if (take_word(first) != "ply" || !take_word(first).empty()) refuse_ply(file, "expected ply in the first line");
    while (!contents.empty()) {
        const std::string_view before = contents;
        const std::string_view line = take_line(contents);
        std::string_view rest = line;
        const std::string_view key = take_word(rest);
        if (key == "end_header") {
            if (!format) refuse_ply(file, "the header names no format");
            header.format = *format;
            if (ends_with_return && !contents.empty()) contents = before.substr(line.size() + 1);
            return header;
        }
        if (key == "format") {
            format = format_named(take_word(rest));
            if (!format || take_word(rest) != "1.0")
                refuse_ply(file,
                           "expected format ascii, binary_little_endian or binary_big_endian 1.0, got " + quoted(line));
        } else if (key == "element") {
            PlyElement element;
            element.name = take_word(rest);
            if (element.name.empty() || !parse_number(take_word(rest), element.count))
                refuse_ply(file, "expected element, a name and a count, got " + quoted(line));
            header.elements.push_back(std::move(element));
        } else if (key == "property") {
            std::optional<PlyProperty> property = parse_property(rest);
            if (!property || header.elements.empty())
                refuse_ply(file, "expected property, a type and a name within an element, got " + quoted(line));
            header.elements.back().properties.push_back(std::move(*property));
        } else if (!key.empty() && key != "comment" && key != "obj_info") {
            refuse_ply(file, "unknown line in the header, " + quoted(line));
        }
    }
    refuse_ply(file, "the header has no end_header");
}

}  // namespace apsl::scenes
