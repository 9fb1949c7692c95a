// SPDX-License-Identifier: MIT
#pragma once

#include "support/meshes.hpp"

#include <string>
#include <vector>

namespace apsl::test {

struct SampleMesh {
    std::string name;
    Mesh mesh;
};

/// One of each kind that a topology must bear: boundaries, closed, several components, edges with three triangles,
/// duplicates, any valence, isolated vertices.
std::vector<SampleMesh> small_meshes();

/// The garments in ../shared/meshes; empty, with a warning, where that folder is absent.
std::vector<SampleMesh> garments();

}  // namespace apsl::test
