// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/error.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

namespace apsl {

// Corner numbers and the offsets into lists of them are 32-bit.
inline constexpr std::size_t greatest_triangle_count = std::numeric_limits<std::uint32_t>::max() / 3;
inline constexpr std::size_t greatest_vertex_count = std::numeric_limits<std::uint32_t>::max();

/// Throws Error(invalid_mesh) where a mesh of so many cannot be, before anything of it is read or copied.
inline void check_mesh_size(std::size_t triangle_count, std::size_t vertex_count) {
    if (triangle_count == 0) throw Error(ErrorCode::invalid_mesh, "the mesh has no triangles, expected at least one");
    const auto check = [](std::size_t count, std::size_t greatest, const char* what) {
        if (count > greatest)
            throw Error(ErrorCode::invalid_mesh, "the mesh has " + std::to_string(count) + " " + what +
                                                     ", expected at most " + std::to_string(greatest));
    };
    check(triangle_count, greatest_triangle_count, "triangles");
    check(vertex_count, greatest_vertex_count, "vertices");
}

}  // namespace apsl
