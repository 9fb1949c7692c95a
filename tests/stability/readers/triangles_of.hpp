// SPDX-License-Identifier: MIT
#pragma once

#include "run/cut_polygons.hpp"
#include "run/weld.hpp"

#include <cstdint>
#include <cstdlib>
#include <utility>

namespace apsl::test {

/// Cuts the faces of a mesh as read, and of the same mesh welded; ends the fuzzer unless every triangle names three
/// different vertices that are there.
inline void check_triangles_of(const scenes::PolygonMesh& polygons) {
    scenes::PolygonMesh welded = polygons;
    const auto check = [](const scenes::Mesh& mesh) {
        for (const Triangle& t : mesh.triangles) {
            if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) std::abort();
            for (const std::uint32_t vertex : t)
                if (vertex >= mesh.vertex_count()) std::abort();
        }
    };
    for (const std::uint32_t vertex : scenes::weld(welded, 0.1))
        if (vertex >= welded.vertex_count()) std::abort();
    check(scenes::cut_polygons(polygons));
    check(scenes::cut_polygons(std::move(welded)));
}

}  // namespace apsl::test
