// SPDX-License-Identifier: MIT
#include "run/read_mesh.hpp"

#include "pipeline/geometry.hpp"
#include "run/byte_order_mark.hpp"
#include "run/cut_polygons.hpp"
#include "run/input_error.hpp"
#include "run/read_file.hpp"
#include "run/read_obj.hpp"
#include "run/read_ply.hpp"
#include "run/weld.hpp"
#include "run/words.hpp"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

namespace apsl::scenes {
namespace {

void scale_to_height(PolygonMesh& mesh, double height) {
    double lowest = mesh.positions[1];
    double highest = lowest;
    for (std::size_t k = 1; k < mesh.positions.size(); k += 3) {
        lowest = std::min(lowest, mesh.positions[k]);
        highest = std::max(highest, mesh.positions[k]);
    }
    if (!(highest > lowest))
        throw InputError(mesh.file + ": all vertices have the same y, mesh.height cannot scale that; leave it out");
    const double scale = height / (highest - lowest);
    for (double& coordinate : mesh.positions) coordinate *= scale;
}

}  // namespace

Mesh read_mesh(const MeshFile& source) {
    const std::string file = source.file.string();
    const std::string bytes = read_file(source.file, "mesh");
    std::string extension = source.file.extension().string();
    for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    if (extension != ".obj" && extension != ".ply")
        throw InputError(file + ": unknown kind of mesh file, expected .obj or .ply");
    const std::string_view contents = without_byte_order_mark(bytes, file);
    PolygonMesh polygons = extension == ".obj" ? read_obj(contents, file) : read_ply(contents, file);
    if (polygons.positions.empty()) throw InputError(file + ": has no vertices");
    if (polygons.faces.empty()) {
        const std::string why = polygons.warnings.empty() ? "" : " (" + polygons.warnings.front() + ")";
        throw InputError(file + ": has no faces" + why);
    }
    if (source.height) scale_to_height(polygons, *source.height);
    std::vector<std::uint32_t> welded_to;
    const double across = extent(polygons.positions);
    if (source.weld > 0.0) welded_to = weld(polygons, source.weld);
    Mesh mesh = cut_polygons(std::move(polygons));
    mesh.welded_to = std::move(welded_to);
    if (mesh.triangles.empty()) {
        std::string what = file + ": has no faces that enclose anything";
        if (source.weld > 0.0) {
            what += " once vertices within mesh.weld, " + short_number(source.weld) +
                    " m, are one; the mesh extends over " + short_number(across) + " m";
        }
        throw InputError(what);
    }
    return mesh;
}

}  // namespace apsl::scenes
