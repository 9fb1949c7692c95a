// SPDX-License-Identifier: MIT
#include "run/polygons.hpp"

#include "run/input_error.hpp"

#include <algorithm>
#include <vector>

namespace apsl::scenes {

void add_polygon(Mesh& mesh, std::span<const std::int64_t> vertices, const std::string& file, std::size_t face) {
    const std::string where = file + ": face " + std::to_string(face) + ": ";
    if (vertices.size() < 3) {
        throw InputError(where + std::to_string(vertices.size()) + " vertices, expected at least 3");
    }
    const auto vertex_count = static_cast<std::int64_t>(mesh.vertex_count());
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        if (vertices[k] < 0 || vertices[k] >= vertex_count) {
            throw InputError(where + "vertex " + std::to_string(vertices[k]) + " is out of range, the file has " +
                             std::to_string(vertex_count) + " vertices");
        }
    }
    // Sorted, so that a polygon of any length takes no longer to check than to read.
    std::vector<std::int64_t> sorted(vertices.begin(), vertices.end());
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end()) throw InputError(where + "names vertex " + std::to_string(*twice) + " twice");
    for (std::size_t k = 1; k + 1 < vertices.size(); ++k) {
        mesh.triangles.push_back({static_cast<std::uint32_t>(vertices[0]), static_cast<std::uint32_t>(vertices[k]),
                                  static_cast<std::uint32_t>(vertices[k + 1])});
    }
}

}  // namespace apsl::scenes
