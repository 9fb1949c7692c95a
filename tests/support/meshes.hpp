// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/topology.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace apsl::test {

/// A mesh with its rest positions.
struct Mesh {
    std::vector<Triangle> triangles;
    std::vector<double> positions;  ///< m, [3V]

    std::size_t vertex_count() const { return positions.size() / 3; }
};

enum class Diagonals { uniform, alternating, random };

/// Grid of columns × rows vertices (each ≥ 2) in the plane y = 0, centred at the origin; vertex (c, r) has index
/// r·columns + c, columns along x, rows along z. Sizes in metres. Random diagonals follow from the seed alone.
Mesh grid(std::uint32_t columns, std::uint32_t rows, double size_x, double size_z, Diagonals diagonals,
          std::uint32_t seed = 1);

/// The right triangle (0,0,0), (2,0,0), (0,1,0): area 1, normal +z.
Mesh right_triangle();
/// Surface of the regular tetrahedron with corners at alternating corners of the cube [−1, 1]³, outward normals.
Mesh tetrahedron();
/// `pages` triangles on one common edge, turned about it: not manifold from three pages on.
Mesh book(std::uint32_t pages);
/// Open fan of `blades` triangles around vertex 0, flat, each 25° wide.
Mesh fan(std::uint32_t blades);

/// Both meshes side by side, the second one moved by 10 m along x.
Mesh together(const Mesh& first, const Mesh& second);

/// The positions lifted to a wavy surface and moved a little out of order, the same for the same seed.
/// amplitude in metres.
std::vector<double> wavy(const std::vector<double>& positions, double amplitude, std::uint32_t seed = 1);

/// Vertices and faces of an OBJ file, polygons fanned, in the file's own units. Throws where the file cannot be read.
Mesh read_obj(const std::string& path);

}  // namespace apsl::test
