// SPDX-License-Identifier: MIT
#include "run/read_obj.hpp"

#include "run/input_error.hpp"
#include "run/polygons.hpp"
#include "run/words.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

namespace apsl::scenes {
namespace {

void add_vertex(Mesh& mesh, std::string_view coordinates, const std::string& place, std::string_view line) {
    for (int axis = 0; axis < 3; ++axis) {
        double coordinate = 0.0;
        if (!parse_number(take_word(coordinates), coordinate) || !std::isfinite(coordinate)) {
            throw InputError(place + "expected three finite coordinates after v, got " + quoted(line));
        }
        mesh.positions.push_back(coordinate);
    }
}

// v, v/vt, v//vn or v/vt/vn: only v is looked at. Counted from 1, or back from the last vertex before the line.
std::int64_t vertex_index(std::string_view corner, const Mesh& mesh, const std::string& place, std::string_view line) {
    std::int64_t number = 0;
    if (!parse_number(corner.substr(0, corner.find('/')), number) || number == 0) {
        throw InputError(place + "expected vertex numbers from 1, or from -1 back, after f, got " + quoted(line));
    }
    return number > 0 ? number - 1 : static_cast<std::int64_t>(mesh.vertex_count()) + number;
}

}  // namespace

Mesh read_obj(std::string_view contents, const std::string& file) {
    Mesh mesh;
    std::vector<std::vector<std::int64_t>> polygons;  // a face may come before its vertices
    for (std::size_t number = 1; !contents.empty(); ++number) {
        const std::string_view line = take_line(contents);
        std::string_view rest = line;
        const std::string_view key = take_word(rest);
        if (key != "v" && key != "f") continue;
        const std::string place = file + ":" + std::to_string(number) + ": ";
        if (key == "v") {
            add_vertex(mesh, rest, place, line);
            continue;
        }
        std::vector<std::int64_t>& polygon = polygons.emplace_back();
        for (std::string_view corner = take_word(rest); !corner.empty() && corner[0] != '#'; corner = take_word(rest)) {
            polygon.push_back(vertex_index(corner, mesh, place, line));
        }
    }
    for (std::size_t face = 0; face < polygons.size(); ++face) add_polygon(mesh, polygons[face], file, face);
    return mesh;
}

}  // namespace apsl::scenes
