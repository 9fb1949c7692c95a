// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

#include <vector>

namespace apsl::methods {

/// One level of a hierarchy over a cloth's vertices. Vertices keep their numbers on every level; the finest level has
/// them all, each coarser one some of those before it.
struct Level {
    std::vector<std::uint32_t> vertices;  ///< ascending
    std::vector<VertexPair> edges;        ///< ascending
    std::vector<float> rest_lengths;      ///< m, one an edge: distance of its vertices at rest

    /// Vertices of this level that the next coarser one lacks, and where their corrections come from: fine vertex n has
    /// the parents parent_offsets[n] up to parent_offsets[n + 1], all in the coarser level; weights add up to 1.
    std::vector<std::uint32_t> fine_vertices;
    std::vector<std::uint32_t> parent_offsets{0};
    std::vector<std::uint32_t> parents;
    std::vector<float> weights;
};

/// At most `level_count` levels, finest first; fewer where nothing is left to coarsen.
/// Müller 2008, "Hierarchical Position Based Dynamics": visited in order, a vertex becomes fine where it has at least
/// two coarse neighbours and takes none of the two from a fine one; its correction comes from its coarse neighbours,
/// weighted by the inverse distance at rest. Edges of the coarser level: those of this one with every fine vertex drawn
/// into its nearest parent, duplicates dropped. Ours: pinned vertices stay on every level, so that each level knows
/// them.
std::vector<Level> coarsen(const Cloth& cloth, int level_count);

/// Moves each fine vertex of `level` by the weighted mean of how far its parents are from `before` (m, [V]).
/// Pinned vertices are parents, never fine.
void interpolate(const Level& level, std::span<const Eigen::Vector3f> before, std::span<Eigen::Vector3f> positions);

}  // namespace apsl::methods
