// SPDX-License-Identifier: MIT
#include "run/override_scene.hpp"

#include "run/input_error.hpp"
#include "run/parse_json.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <vector>

namespace apsl::scenes {
namespace {

// "pins[0].box" and "pins.0.box" are the same path.
std::vector<std::string> split_path(std::string path) {
    for (std::size_t k = 0; k < path.size(); ++k) {
        if (path[k] == '[') path[k] = '.';
        if (path[k] == ']') path.erase(k--, 1);
    }
    std::vector<std::string> keys;
    for (std::size_t first = 0; first <= path.size();) {
        const std::size_t end = std::min(path.find('.', first), path.size());
        keys.push_back(path.substr(first, end - first));
        first = end + 1;
    }
    return keys;
}

// Anything else would stop whoever writes the scene down, late.
bool is_utf8(const std::string& text) {
    try {
        nlohmann::json(text).dump();
        return true;
    } catch (const nlohmann::json::type_error&) {
        return false;
    }
}

std::optional<std::size_t> as_index(const std::string& key) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
    return error == std::errc{} && end == key.data() + key.size() ? std::optional(index) : std::nullopt;
}

// A mesh that is a grid becomes a file by --set mesh.file=..., without taking the grid out first.
template <class Json>
void replace_other_kinds(Json& document, const std::vector<std::string>& path) {
    const std::vector<std::string> meshes{"grid", "tube", "file"};
    const std::vector<std::string> integrators{"implicit_springs", "bending_springs", "stand_alone", "none"};
    if (path.size() < 2 || !document.contains(path[0]) || !document[path[0]].is_object()) return;
    const std::vector<std::string>& kinds = path[0] == "mesh" ? meshes : integrators;
    if (path[0] != "mesh" && path[0] != "integrator") return;
    if (std::find(kinds.begin(), kinds.end(), path[1]) == kinds.end()) return;
    for (const std::string& kind : kinds)
        if (kind != path[1]) document[path[0]].erase(kind);
    if (path[0] == "mesh" && path[1] != "file")
        for (const char* key : {"height", "weld"}) document[path[0]].erase(key);
}

}  // namespace

template <class Json>
bool override_scene(Json& document, const std::string& assignment) {
    const std::size_t equals = assignment.find('=');
    const std::vector<std::string> path = split_path(assignment.substr(0, equals));
    if (equals == std::string::npos || std::find(path.begin(), path.end(), "") != path.end())
        throw InputError("--set " + assignment + ": expected path=value, such as strain_limiting.regularization=1.05");
    if (path.size() > max_scene_depth) {
        throw InputError("--set " + path[0] + "...: a path of " + std::to_string(path.size()) +
                         " keys, expected at most " + std::to_string(max_scene_depth));
    }
    if (!is_utf8(assignment)) throw InputError("--set " + assignment + ": expected text in UTF-8");
    const std::string text = assignment.substr(equals + 1);
    Json value = Json::accept(text) ? Json(parse_json(text, "--set " + assignment)) : Json(text);

    replace_other_kinds(document, path);
    Json* place = &document;
    for (std::size_t k = 0; k < path.size(); ++k) {
        const bool last = k + 1 == path.size();
        if (place->is_null()) {
            if (k > 0 && as_index(path[k]))
                throw InputError("--set " + assignment + ": there is no \"" + path[k - 1] +
                                 "\" in the scene, expected all of it, " + path[k - 1] + "=[...]");
            if (value.is_null()) return false;
            *place = Json::object();
        }
        if (place->is_object()) {
            if (value.is_null() && !place->contains(path[k])) return false;
            if (last && value.is_null()) {
                place->erase(path[k]);
                return true;
            }
            place = &(*place)[path[k]];
        } else if (const auto index = as_index(path[k]); place->is_array() && index && *index <= place->size()) {
            // An entry that is null stays, to be refused as in a file: without it the others would move up.
            if (*index == place->size()) place->push_back(nullptr);
            place = &(*place)[*index];
        } else {
            throw InputError("--set " + assignment + ": there is no \"" + path[k] + "\" in " + place->dump());
        }
    }
    *place = std::move(value);
    if (path == std::vector<std::string>{"mesh", "file"} && place->is_string())
        *place = std::filesystem::absolute(place->template get<std::string>()).lexically_normal().string();
    return true;
}

template <class Json>
void override_scene(Json& document, std::span<const std::string> assignments) {
    for (const std::string& assignment : assignments)
        if (!override_scene(document, assignment))
            std::fprintf(stderr, "warning: --set %s: there is no such key in the scene to take out\n",
                         assignment.c_str());
}

template bool override_scene(nlohmann::json&, const std::string&);
template bool override_scene(nlohmann::ordered_json&, const std::string&);
template void override_scene(nlohmann::json&, std::span<const std::string>);
template void override_scene(nlohmann::ordered_json&, std::span<const std::string>);

}  // namespace apsl::scenes
