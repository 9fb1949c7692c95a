// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/topology.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace apsl::scenes {

/// Energy ½ k (|x_b − x_a| − L)².
struct Spring {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    double rest_length = 0.0;  ///< m, L ≥ 0
    double stiffness = 0.0;    ///< N/m, k ≥ 0
};

/// At rest at `rest_positions` (m, [3V]), the smaller index first.
Spring make_spring(std::uint32_t a, std::uint32_t b, std::span<const double> rest_positions, double stiffness);

/// One spring per edge. On a triangle grid the diagonal edges are the shear springs of Baraff and Witkin's split into
/// stretch, shear and bending; they are as stiff as the others.
/// Here and below: `rest_positions` m, [3V]; `stiffness` N/m. Throws Error(invalid_argument) for a size that does not
/// fit and for a stiffness that is negative or not finite.
std::vector<Spring> stretch_springs(const Topology& topology, std::span<const double> rest_positions, double stiffness);

/// One linear spring per interior edge, between the two vertices opposite it; every pair of opposite vertices where
/// more than two triangles meet at an edge. Where two edges give the same pair (around a vertex of four triangles) that
/// pair has two springs.
std::vector<Spring> bending_springs(const Topology& topology, std::span<const double> rest_positions, double stiffness);

/// The springs of the stand-alone solver (Section 6 of the paper), and what had to be added to the plain bending
/// springs.
struct StandAloneSprings {
    std::vector<Spring> springs;
    std::size_t bending = 0;           ///< across interior edges
    std::size_t lattices = 0;          ///< connected parts that these leave the mesh in, all its components together
    std::size_t second_ring = 0;       ///< between vertices two edges apart, one of them not held from all sides
    std::size_t between_lattices = 0;  ///< between vertices two edges apart, in different lattices
    std::size_t connecting = 0;        ///< along edges, in patches too small for either
};

/// What holds a cloth together where area is all else that does (no stretch springs).
StandAloneSprings stand_alone_springs(const Topology& topology, std::span<const double> rest_positions,
                                      double stiffness);

/// Parts that the springs leave the vertices in; vertices in no triangle are not counted.
std::size_t connected_parts(const Topology& topology, std::span<const Spring> springs);

}  // namespace apsl::scenes
