// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"
#include "pipeline/pins.hpp"
#include "run/cap_triangles.hpp"
#include "run/light_vertices.hpp"
#include "run/needle_triangles.hpp"
#include "run/pieces.hpp"
#include "run/scene.hpp"

#include <string>
#include <vector>

namespace apsl::scenes {

/// A scene's mesh as a cloth at rest, and what a user should know of it.
struct SceneCloth {
    ClothState state;
    std::vector<PinGroup> pins;
    Pieces pieces;
    LightVertices light;
    CapTriangles caps;
    NeedleTriangles needles;
    std::vector<std::string> warnings;  ///< one line each, with what to do
};

/// Makes or reads the mesh, builds its topology and resolves the pins. Throws InputError naming the scene or mesh file;
/// among others for a triangle of rest area 0 and for a list of values that does not fit the mesh.
SceneCloth make_scene_cloth(const Scene& scene);

}  // namespace apsl::scenes
