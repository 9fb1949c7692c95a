// SPDX-License-Identifier: MIT
#include "run/make_mesh.hpp"

#include "run/fixed_sequence.hpp"

#include <cmath>
#include <numbers>

namespace apsl::scenes {
namespace {

class DiagonalChoice {
public:
    explicit DiagonalChoice(Diagonals diagonals) : diagonals_(diagonals) {}

    /// Whether the cell's diagonal leaves from its first corner (c, r).
    bool from_first_corner(std::uint32_t c, std::uint32_t r) {
        switch (diagonals_) {
            case Diagonals::uniform:
                return false;
            case Diagonals::alternating:
                return (c + r) % 2 == 0;
            case Diagonals::random:
                return coins_.coin();
        }
        return false;
    }

private:
    Diagonals diagonals_;
    FixedSequence coins_;
};

// The cell's corners: a (c, r), b (c + 1, r), d (c, r + 1), e (c + 1, r + 1); counter-clockwise is a, d, e, b.
void add_cell(std::vector<Triangle>& triangles, std::uint32_t a, std::uint32_t b, std::uint32_t d, std::uint32_t e,
              bool diagonal_from_a) {
    if (diagonal_from_a) {
        triangles.push_back({a, d, e});
        triangles.push_back({a, e, b});
    } else {
        triangles.push_back({a, d, b});
        triangles.push_back({b, d, e});
    }
}

}  // namespace

Mesh make_mesh(const GridMesh& grid) {
    const auto [columns, rows] = grid.vertices;
    Mesh mesh;
    mesh.positions.reserve(std::size_t{3} * columns * rows);
    FixedSequence jitter;
    for (std::uint32_t r = 0; r < rows; ++r) {
        for (std::uint32_t c = 0; c < columns; ++c) {
            double along_columns = c;
            double along_rows = r;
            if (grid.jitter > 0.0 && c > 0 && c + 1 < columns && r > 0 && r + 1 < rows) {
                along_columns += 0.25 * grid.jitter * jitter.symmetric();
                along_rows += 0.25 * grid.jitter * jitter.symmetric();
            }
            const double u = (along_columns / (columns - 1) - 0.5) * grid.size[0];
            const double v = (along_rows / (rows - 1) - 0.5) * grid.size[1];
            const bool horizontal = grid.plane == GridPlane::horizontal;
            mesh.positions.insert(mesh.positions.end(), {u, horizontal ? 0.0 : -v, horizontal ? v : 0.0});
        }
    }

    mesh.triangles.reserve(std::size_t{2} * (columns - 1) * (rows - 1));
    DiagonalChoice diagonal(grid.diagonals);
    for (std::uint32_t r = 0; r + 1 < rows; ++r) {
        for (std::uint32_t c = 0; c + 1 < columns; ++c) {
            const std::uint32_t a = r * columns + c;
            const bool from_first_corner = diagonal.from_first_corner(c, r);
            add_cell(mesh.triangles, a, a + 1, a + columns, a + columns + 1, from_first_corner);
        }
    }
    return mesh;
}

Mesh make_mesh(const TubeMesh& tube) {
    const auto [around, down] = tube.segments;
    Mesh mesh;
    mesh.positions.reserve(std::size_t{3} * around * (std::size_t{down} + 1));
    FixedSequence jitter;
    for (std::uint32_t r = 0; r <= down; ++r) {
        for (std::uint32_t c = 0; c < around; ++c) {
            double place = c;
            double ring = r;
            if (tube.jitter > 0.0 && r > 0 && r < down) {
                place += 0.25 * tube.jitter * jitter.symmetric();
                ring += 0.25 * tube.jitter * jitter.symmetric();
            }
            const double angle = 2.0 * std::numbers::pi * place / around;
            const double fraction = ring / down;
            const double radius = tube.radius[0] + fraction * (tube.radius[1] - tube.radius[0]);
            mesh.positions.insert(mesh.positions.end(), {radius * std::cos(angle), (0.5 - fraction) * tube.height,
                                                         -radius * std::sin(angle)});
        }
    }

    mesh.triangles.reserve(std::size_t{2} * around * down);
    DiagonalChoice diagonal(tube.diagonals);
    for (std::uint32_t r = 0; r < down; ++r) {
        for (std::uint32_t c = 0; c < around; ++c) {
            const std::uint32_t next = (c + 1) % around;
            const std::uint32_t row = r * around;
            const bool from_first_corner = diagonal.from_first_corner(c, r);
            add_cell(mesh.triangles, row + c, row + next, row + around + c, row + around + next, from_first_corner);
        }
    }
    return mesh;
}

}  // namespace apsl::scenes
