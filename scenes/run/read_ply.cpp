// SPDX-License-Identifier: MIT
#include "run/read_ply.hpp"

#include "run/input_error.hpp"
#include "run/polygons.hpp"

#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace apsl::scenes {

Mesh read_ply(const std::filesystem::path& file) {
    Assimp::Importer importer;
    // No post-processing flags: vertices stay as they are in the file, none split, none joined.
    const aiScene* scene = importer.ReadFile(file.string(), 0);
    if (scene == nullptr || scene->mNumMeshes != 1) {
        std::string reason = importer.GetErrorString();
        for (char& letter : reason) {
            if (letter == '\n' || letter == '\r') letter = ' ';
        }
        throw InputError(file.string() + ": not a readable PLY mesh" + (reason.empty() ? "" : ": " + reason));
    }

    const aiMesh& source = *scene->mMeshes[0];
    Mesh mesh;
    mesh.positions.reserve(std::size_t{3} * source.mNumVertices);
    for (unsigned v = 0; v < source.mNumVertices; ++v) {
        const aiVector3D& place = source.mVertices[v];
        if (!std::isfinite(place.x) || !std::isfinite(place.y) || !std::isfinite(place.z)) {
            throw InputError(file.string() + ": vertex " + std::to_string(v) + ": expected three finite coordinates");
        }
        mesh.positions.insert(mesh.positions.end(), {place.x, place.y, place.z});
    }
    for (unsigned face = 0; face < source.mNumFaces; ++face) {
        const aiFace& corners = source.mFaces[face];
        std::vector<std::int64_t> polygon;
        // Signed again: Assimp reads an index of −1 as 2³² − 1.
        for (unsigned k = 0; k < corners.mNumIndices; ++k) {
            polygon.push_back(static_cast<std::int32_t>(corners.mIndices[k]));
        }
        add_polygon(mesh, polygon, file.string(), face);
    }
    return mesh;
}

}  // namespace apsl::scenes
