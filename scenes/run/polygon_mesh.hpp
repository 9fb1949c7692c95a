// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace apsl::scenes {

/// Vertices and faces as a mesh file has them, before faces are cut into triangles.
struct PolygonMesh {
    struct Face {
        std::size_t end;       ///< behind its last corner
        std::uint64_t number;  ///< its line, or its number among the faces
    };

    std::string file;                     ///< what messages name
    bool has_lines = false;               ///< whether Face::number is a line
    std::vector<double> positions;        ///< m, [3V]
    std::vector<std::int64_t> numbers;    ///< of the corners' vertices, as the file writes them
    std::vector<std::uint32_t> vertices;  ///< the same, counted from 0
    std::vector<Face> faces;              ///< one after the other in `vertices`
    std::vector<std::string> warnings;    ///< of what was left out, one line each, with the file's name

    std::size_t vertex_count() const { return positions.size() / 3; }
    std::span<const std::uint32_t> corners(std::size_t face) const;

    /// The vertex counted from 0; what is out of any range is kept for check_faces to find.
    void add_corner(std::int64_t number, std::int64_t vertex);
    void end_face(std::uint64_t number) { faces.push_back({vertices.size(), number}); }

    /// "mesh.obj:7: " or "mesh.ply: face 7: ", for errors.
    std::string where(std::size_t face) const;
    /// "line 7, 4 4 1": the numbers of its vertices as the file writes them; of a long face the first ones.
    std::string shown(std::size_t face) const;
};

/// Throws InputError for a face with fewer than three corners or with a vertex that is not there.
void check_faces(const PolygonMesh& mesh);

}  // namespace apsl::scenes
