// SPDX-License-Identifier: MIT
#include "run/read_obj.hpp"

#include "run/input_error.hpp"
#include "run/polygons.hpp"

#include <tiny_obj_loader.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>
#include <vector>

namespace apsl::scenes {
namespace {

std::string_view without_leading_blanks(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    return first == std::string_view::npos ? std::string_view{} : text.substr(first);
}

// tinyobjloader takes a coordinate that it cannot read, "nan" among them, for 0. So look at them first.
void check_coordinates(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::string line;
    for (std::size_t number = 1; std::getline(stream, line); ++number) {
        std::string_view rest = without_leading_blanks(line);
        if (!rest.starts_with("v ") && !rest.starts_with("v\t")) continue;
        rest.remove_prefix(1);
        for (int axis = 0; axis < 3; ++axis) {
            rest = without_leading_blanks(rest);
            if (rest.starts_with('+')) rest.remove_prefix(1);
            double coordinate = 0.0;
            const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), coordinate);
            const bool ends_well = end == rest.data() + rest.size() || *end == ' ' || *end == '\t' || *end == '\r';
            if (error != std::errc{} || !ends_well || !std::isfinite(coordinate)) {
                throw InputError(file.string() + ":" + std::to_string(number) +
                                 ": expected three finite coordinates after v, got \"" +
                                 std::string(without_leading_blanks(line)) + "\"");
            }
            rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
        }
    }
}

}  // namespace

Mesh read_obj(const std::filesystem::path& file) {
    check_coordinates(file);

    tinyobj::ObjReaderConfig config;
    config.triangulate = false;  // fans are cut here, alike for all formats
    config.vertex_color = false;
    tinyobj::ObjReader reader;
    if (!reader.ParseFromFile(file.string(), config)) {
        std::string reason = reader.Error();
        reason.erase(reason.find_last_not_of(" \n\r") + 1);
        for (char& letter : reason) {
            if (letter == '\n') letter = ' ';
        }
        throw InputError(file.string() + ": not a readable OBJ file" + (reason.empty() ? "" : ": " + reason));
    }

    Mesh mesh;
    mesh.positions = reader.GetAttrib().vertices;
    std::size_t face = 0;
    for (const tinyobj::shape_t& shape : reader.GetShapes()) {
        std::size_t first = 0;
        for (const std::size_t count : shape.mesh.num_face_vertices) {
            std::vector<std::int64_t> polygon;
            for (std::size_t k = 0; k < count; ++k) polygon.push_back(shape.mesh.indices[first + k].vertex_index);
            add_polygon(mesh, polygon, file.string(), face++);
            first += count;
        }
    }
    return mesh;
}

}  // namespace apsl::scenes
