// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/topology.hpp>

#include <cstdint>
#include <vector>

namespace apsl {

/// An order of a mesh in which what lies together is numbered together. The triangles come in patches, compact pieces
/// of surface, so that one work-group can hold all a patch's vertices at hand.
struct Patches {
    std::vector<std::uint32_t> triangle_order;  ///< [T], place → triangle of the topology
    std::vector<std::uint32_t> patch_offsets;   ///< [patches + 1], places where patches begin
    std::vector<std::uint32_t>
        vertex_order;  ///< [V], place → vertex of the topology, by patch of first use, in it by valence
};

/// Grows patches breadth-first over shared vertices, each from the rim of those before, to at most `max_triangles`.
/// Linear in the number of triangles.
APSL_API Patches build_patches(const Topology& topology, std::uint32_t max_triangles);

}  // namespace apsl
