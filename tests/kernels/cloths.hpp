// SPDX-License-Identifier: MIT
#pragma once

#include "reference/geometry.hpp"
#include "reference/matrix.hpp"
#include "support/meshes.hpp"

#include <apsl/parameters.hpp>
#include <apsl/topology.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace apsl::test {

/// A deformed cloth with pins and unequal masses. Every number is a 32-bit float, held in double: the reference and the
/// kernels are given the same.
struct Cloth {
    std::shared_ptr<const Topology> topology;
    std::vector<double> positions;         ///< m, [3V]
    std::vector<double> velocities;        ///< m/s, [3V]
    std::vector<double> inverse_masses;    ///< 1/kg, [V], every seventh 0
    std::vector<double> rest_areas;        ///< m², [T], within a third of the areas
    std::vector<double> regularization;    ///< α, [T], from 1 to 3
    std::vector<double> rest_shapes;       ///< 1/m, [4T], of a cloth a tenth narrower
    std::vector<double> rest_hinges;       ///< rad and m²/m², [2H], half flat, every sixth free
    std::vector<double> stretch_ceilings;  ///< [T], from 1.02 to 1.2, every ninth 0
    /// [8V], Buffers::contacts: planes up to 0.1 m before and behind `positions`, every fifth vertex without one.
    std::vector<double> contacts;
    std::vector<double> accelerations;  ///< m/s², [3V], up to 20 either way
};

Cloth make_cloth(const Mesh& mesh, std::uint32_t seed);

/// A cloth of each kind of small mesh.
std::vector<Cloth> every_kind_of_mesh();

/// A zigzag strip of n triangles with edges of about 1 m and n + 2 vertices: any number of triangles, short rows.
Mesh strip(std::uint32_t triangles);

/// Reproducible numbers in [low, high), each a 32-bit float.
std::vector<double> random_numbers(std::size_t count, double low, double high, std::uint32_t seed);

/// What the reference makes of a cloth at its present positions, in the scaled unknowns of kernels/gradients.h.
struct ScaledSolve {
    std::vector<reference::TriangleGeometry<double>> geometry;
    std::vector<double> scale;                                     ///< s = 1/√(α D), 0 where D is
    std::vector<std::array<Eigen::Vector3d, 3>> scaled_gradients;  ///< ḡ_k = s √(w_k / 2) g_k, of each corner
    std::vector<double> scaled_diagonal;                           ///< α D
    std::vector<double> right_hand_side;                           ///< s (A − A⁰)
    reference::SparseMatrix<double> rows;                          ///< S (G + (α − 1) D) S
};

ScaledSolve scaled_solve(const Cloth& cloth, Matrix matrix, const std::vector<double>& alpha);

}  // namespace apsl::test
