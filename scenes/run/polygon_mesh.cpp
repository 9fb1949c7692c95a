// SPDX-License-Identifier: MIT
#include "run/polygon_mesh.hpp"

#include "run/input_error.hpp"

#include <algorithm>
#include <limits>

namespace apsl::scenes {
namespace {

constexpr std::uint32_t no_vertex = std::numeric_limits<std::uint32_t>::max();

std::size_t first_corner(const PolygonMesh& mesh, std::size_t face) {
    return face == 0 ? 0 : mesh.faces[face - 1].end;
}

}  // namespace

std::span<const std::uint32_t> PolygonMesh::corners(std::size_t face) const {
    const std::size_t first = first_corner(*this, face);
    return std::span(vertices).subspan(first, faces[face].end - first);
}

void PolygonMesh::add_corner(std::int64_t number, std::int64_t vertex) {
    numbers.push_back(number);
    vertices.push_back(vertex < 0 || vertex >= no_vertex ? no_vertex : static_cast<std::uint32_t>(vertex));
}

std::string PolygonMesh::where(std::size_t face) const {
    return file + (has_lines ? ":" : ": face ") + std::to_string(faces[face].number) + ": ";
}

std::string PolygonMesh::shown(std::size_t face) const {
    constexpr std::size_t most = 8;
    const std::size_t first = first_corner(*this, face);
    const std::size_t count = faces[face].end - first;
    std::string text = (has_lines ? "line " : "face ") + std::to_string(faces[face].number) + ",";
    for (std::size_t k = 0; k < std::min(count, most); ++k) text.append(" ").append(std::to_string(numbers[first + k]));
    return count > most ? text + " ..." : text;
}

void check_faces(const PolygonMesh& mesh) {
    const std::size_t vertex_count = mesh.vertex_count();
    std::size_t corner = 0;
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        const std::size_t corners = mesh.faces[face].end - corner;
        if (corners < 3)
            throw InputError(mesh.where(face) + std::to_string(corners) + " vertices, expected at least 3");
        for (; corner < mesh.faces[face].end; ++corner) {
            if (mesh.vertices[corner] >= vertex_count) {
                throw InputError(mesh.where(face) + "vertex " + std::to_string(mesh.numbers[corner]) +
                                 " is out of range, the file has " + std::to_string(vertex_count) + " vertices");
            }
        }
    }
}

}  // namespace apsl::scenes
