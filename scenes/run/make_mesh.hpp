// SPDX-License-Identifier: MIT
#pragma once

#include "run/mesh.hpp"

#include <array>
#include <cstdint>

namespace apsl::scenes {

/// Which way the cells of a grid are cut in two.
enum class Diagonals {
    uniform,      ///< all the same way
    alternating,  ///< like a chess board
    random,       ///< by a coin that falls the same way in every run
};

/// The coordinate plane a grid lies in.
enum class GridPlane {
    horizontal,  ///< rows along z, normals up
    vertical,    ///< rows down −y, normals along z
};

/// A rectangle centred at the origin. Vertex (column c, row r) has index r · columns + c, columns along x.
struct GridMesh {
    std::array<std::uint32_t, 2> vertices{65, 65};  ///< columns, rows; ≥ 2
    std::array<double, 2> size{1.0, 1.0};           ///< m, along the columns and along the rows, > 0
    Diagonals diagonals = Diagonals::alternating;
    double jitter = 0.0;  ///< in [0, 1): inner vertices are moved by up to jitter/4 of a cell either way, in the plane
    GridPlane plane = GridPlane::horizontal;
};

/// An open tube around the y axis, centred at the origin, rings from the top down. Vertex (place c around, ring r) has
/// index r · segments[0] + c; places go counter-clockwise seen from above, the first on +x. Normals point outward.
struct TubeMesh {
    std::array<double, 2> radius{0.2, 0.35};        ///< m, top and bottom, > 0
    double height = 0.6;                            ///< m, > 0
    std::array<std::uint32_t, 2> segments{96, 64};  ///< around ≥ 3, down ≥ 1; there is one ring more than segments down
    Diagonals diagonals = Diagonals::uniform;
    double jitter = 0.0;  ///< in [0, 1), as in GridMesh; the top and the bottom ring stay
};

/// Sizes are taken as given: parse_scene checks them. Jitter below 1 turns no triangle of a grid over: a quarter of a
/// cell is the limit.
Mesh make_mesh(const GridMesh& grid);
Mesh make_mesh(const TubeMesh& tube);

}  // namespace apsl::scenes
