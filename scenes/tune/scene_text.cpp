// SPDX-License-Identifier: MIT
#include "tune/scene_text.hpp"

namespace apsl::scenes {
namespace {

constexpr std::size_t width = 120;

using Json = nlohmann::ordered_json;

std::string on_one_line(const Json& value) {
    if (!value.is_structured() || value.empty()) return value.dump();
    std::string text;
    for (const auto& [key, entry] : value.items()) {
        if (!text.empty()) text += ", ";
        if (value.is_object()) text += Json(key).dump() + ": ";
        text += on_one_line(entry);
    }
    return value.is_object() ? '{' + text + '}' : '[' + text + ']';
}

// `used`: characters that stand before the value in its line.
std::string text_of(const Json& value, std::size_t indentation, std::size_t used) {
    std::string line = on_one_line(value);
    const bool whole_scene = indentation == 0;
    if (!value.is_structured() || value.empty() || (!whole_scene && used + line.size() < width)) return line;
    std::string text(1, value.is_object() ? '{' : '[');
    const std::string margin(indentation + 2, ' ');
    bool first = true;
    for (const auto& [key, entry] : value.items()) {
        const std::string name = value.is_object() ? Json(key).dump() + ": " : std::string();
        text.append(first ? "\n" : ",\n").append(margin).append(name);
        text += text_of(entry, indentation + 2, margin.size() + name.size());
        first = false;
    }
    text.append("\n").append(indentation, ' ');
    text += value.is_object() ? '}' : ']';
    return text;
}

}  // namespace

std::string scene_text(const Json& document) {
    return text_of(document, 0, 0) + '\n';
}

}  // namespace apsl::scenes
