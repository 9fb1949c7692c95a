// SPDX-License-Identifier: MIT
#include "run/read_mesh.hpp"

#include "run/input_error.hpp"
#include "run/read_obj.hpp"
#include "run/read_ply.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <string>

namespace apsl::scenes {
namespace {

void scale_to_height(Mesh& mesh, double height, const std::string& file) {
    double lowest = mesh.positions[1];
    double highest = lowest;
    for (std::size_t k = 1; k < mesh.positions.size(); k += 3) {
        lowest = std::min(lowest, mesh.positions[k]);
        highest = std::max(highest, mesh.positions[k]);
    }
    if (!(highest > lowest)) {
        throw InputError(file + ": all vertices have the same y, mesh.height cannot scale that; leave it out");
    }
    const double scale = height / (highest - lowest);
    for (double& coordinate : mesh.positions) coordinate *= scale;
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& file, std::optional<double> height) {
    if (!std::filesystem::is_regular_file(file)) throw InputError(file.string() + ": no such mesh file");
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError(file.string() + ": cannot be opened for reading");

    std::string extension = file.extension().string();
    for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    if (extension != ".obj" && extension != ".ply") {
        throw InputError(file.string() + ": unknown kind of mesh file, expected .obj or .ply");
    }
    const std::string contents{std::istreambuf_iterator<char>(stream), {}};
    Mesh mesh = extension == ".obj" ? read_obj(contents, file.string()) : read_ply(contents, file.string());
    if (mesh.positions.empty()) throw InputError(file.string() + ": has no vertices");
    if (mesh.triangles.empty()) throw InputError(file.string() + ": has no faces");
    if (height) scale_to_height(mesh, *height, file.string());
    return mesh;
}

}  // namespace apsl::scenes
