// SPDX-License-Identifier: MIT
#include "run/cut_polygons.hpp"

#include "pipeline/geometry.hpp"
#include "run/ear_clipping.hpp"
#include "run/input_error.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <string>
#include <utility>
#include <vector>

namespace apsl::scenes {
namespace {

/// Faces with the same flaw.
struct Flawed {
    std::size_t count = 0;
    std::size_t first = 0;

    void add(std::size_t face) {
        if (count++ == 0) first = face;
    }
    void warn(const PolygonMesh& polygons, const std::string& what, const std::string& then, Mesh& mesh) const {
        if (count == 0) return;
        mesh.warnings.push_back(polygons.file + ": " + what + ": " + std::to_string(count) + ", the first in " +
                                polygons.shown(first) + "; " + then);
    }
};

// Takes out what encloses nothing: a vertex that follows itself, and b of a b a. Round the end as well.
void take_out_spikes(std::span<const std::uint32_t> corners, std::vector<std::uint32_t>& polygon) {
    polygon.clear();
    for (const std::uint32_t vertex : corners) {
        if (!polygon.empty() && polygon.back() == vertex) continue;
        if (polygon.size() >= 2 && polygon[polygon.size() - 2] == vertex) {
            polygon.pop_back();
            continue;
        }
        polygon.push_back(vertex);
    }
    std::size_t begin = 0;
    while (polygon.size() - begin >= 2)
        if (polygon.back() == polygon[begin])
            polygon.pop_back();
        else if (polygon[polygon.size() - 2] == polygon[begin])
            polygon.pop_back();  // the spike's end; the rest closes the ring
        else if (polygon.back() == polygon[begin + 1])
            ++begin;
        else
            break;
    polygon.erase(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(begin));
}

bool names_a_vertex_twice(std::span<const std::uint32_t> corners) {
    std::vector<std::uint32_t> sorted(corners.begin(), corners.end());
    std::sort(sorted.begin(), sorted.end());
    return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

// `polygon`: the face's corners without spikes.
void check_areas(const PolygonMesh& polygons, std::size_t face, std::span<const std::uint32_t> polygon,
                 const Mesh& mesh, std::size_t first_triangle) {
    for (std::size_t k = first_triangle; k < mesh.triangles.size(); ++k) {
        const double area = triangle_area(mesh.positions, mesh.triangles[k]);
        if (area > 0.0 && std::isfinite(area)) continue;
        if (!(area <= 0.0)) {
            throw InputError(polygons.where(face) + "a face with an area too great for a number (" +
                             polygons.shown(face) + "); scale the mesh: \"height\" in mesh");
        }
        if (names_a_vertex_twice(polygon)) {
            throw InputError(polygons.where(face) + "a face that pinches itself (" + polygons.shown(face) +
                             "), for a vertex comes twice; cut it there in the mesh");
        }
        throw InputError(polygons.where(face) + "a face without an area, or with vertices in one place (" +
                         polygons.shown(face) + "); delete it, or merge the vertices: \"weld\" in mesh");
    }
}

/// A triangle whichever way round and from whichever corner, and the face it is of.
struct Side {
    Triangle vertices;
    std::size_t face;

    auto operator<=>(const Side&) const = default;
};

// Faces with a triangle that an earlier one has too, as exporters of two-sided cloth write them.
Flawed repeated_faces(std::vector<Side>& sides) {
    std::sort(sides.begin(), sides.end());
    std::vector<std::size_t> faces;
    for (std::size_t k = 1; k < sides.size(); ++k)
        if (sides[k].vertices == sides[k - 1].vertices) faces.push_back(sides[k].face);
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces.empty() ? Flawed{} : Flawed{.count = faces.size(), .first = faces[0]};
}

}  // namespace

Mesh cut_polygons(PolygonMesh polygons) {
    Mesh mesh;
    mesh.positions = std::move(polygons.positions);
    mesh.warnings = std::move(polygons.warnings);
    Flawed empty, crossing;
    std::vector<std::uint32_t> polygon;
    std::vector<Side> sides;
    for (std::size_t face = 0; face < polygons.faces.size(); ++face) {
        take_out_spikes(polygons.corners(face), polygon);
        if (polygon.size() < 3) {
            empty.add(face);
            continue;
        }
        const std::size_t first_triangle = mesh.triangles.size();
        const PolygonCut cut = cut_polygon(mesh.positions, polygon, mesh.triangles);
        if (cut == PolygonCut::too_long) {
            throw InputError(polygons.where(face) + "a concave face of " + std::to_string(polygon.size()) +
                             " vertices, too many to be cut here; cut it into smaller ones in the mesh");
        }
        if (cut == PolygonCut::crossing) crossing.add(face);
        check_areas(polygons, face, polygon, mesh, first_triangle);
        for (std::size_t k = first_triangle; k < mesh.triangles.size(); ++k) {
            sides.push_back({mesh.triangles[k], face});
            std::sort(sides.back().vertices.begin(), sides.back().vertices.end());
        }
    }
    empty.warn(polygons, "faces that enclose nothing, for a vertex comes twice", "they are left out", mesh);
    crossing.warn(polygons, "faces that cross or pinch themselves", "their triangles may overlap, cut them in the mesh",
                  mesh);
    repeated_faces(sides).warn(polygons, "faces that come twice", "each weighs and counts, delete them from the mesh",
                               mesh);
    return mesh;
}

}  // namespace apsl::scenes
