// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/cxx20.hpp>
#include <apsl/export.hpp>
#include <apsl/options.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace apsl {

/// Three vertex indices, counter-clockwise.
using Triangle = std::array<std::uint32_t, 3>;

/// Vertex pair, smaller index first.
using VertexPair = std::array<std::uint32_t, 2>;

/// Two triangles that meet at an edge: the edge's vertices, smaller index first, and the vertices opposite it, that of
/// the triangle with the smaller number first.
using Hinge = std::array<std::uint32_t, 4>;

/// Corner k of triangle a is the number 3a + k. Edge k of a triangle is the one opposite its corner k.
using Corner = std::uint32_t;

/// Sparsity of a matrix over triangles, rows sorted by column, diagonal always present.
/// shared[e] tells for entry e = (a, c) how the two triangles meet: two bits for each corner k of a,
/// lowest bits first. consistent: the corner of c at the same vertex, 3 where there is none.
/// printed: the corner of c opposite the same edge as corner k of a, 3 where there is none.
/// On the diagonal each corner meets itself (0, 1, 2).
struct CsrPattern {
    std::vector<std::uint32_t> row_offsets;  ///< [T + 1]
    std::vector<std::uint32_t> columns;      ///< [entries]
    std::vector<std::uint8_t> shared;        ///< [entries]
};

/// What is known of a mesh without its positions: built once on the host, immutable, shared.
/// Any triangles will do: boundaries, several components, edges with three or more triangles, any valence,
/// vertices in no triangle (they are counted and otherwise ignored).
class APSL_API Topology {
public:
    /// Linear in the number of triangles. Throws Error(invalid_mesh) for no triangles, an index ≥ vertex_count,
    /// a triangle that names a vertex twice, or more than 2³² / 3 triangles; the message names the triangle.
    static std::shared_ptr<const Topology> build(std::span<const Triangle> triangles, std::size_t vertex_count);

    /// As given to build, isolated vertices included: V.
    std::size_t vertex_count() const noexcept { return vertex_count_; }
    /// T.
    std::size_t triangle_count() const noexcept { return triangles_.size(); }
    /// As given to build. [T]; like every span here it lives as long as the topology.
    std::span<const Triangle> triangles() const noexcept { return triangles_; }

    /// Corners at vertex v, ascending: corners()[corner_offsets()[v]] up to corner_offsets()[v + 1].
    std::span<const std::uint32_t> corner_offsets() const noexcept { return corner_offsets_; }  ///< [V + 1]
    std::span<const Corner> corners() const noexcept { return corners_; }                       ///< [3T]

    /// Edges in ascending order, and the corners opposite each: one on a boundary, two inside, more where not manifold.
    std::span<const VertexPair> edges() const noexcept { return edges_; }                                 ///< [E]
    std::span<const std::uint32_t> edge_corner_offsets() const noexcept { return edge_corner_offsets_; }  ///< [E + 1]
    std::span<const Corner> edge_corners() const noexcept { return edge_corners_; }                       ///< [3T]

    /// Edges of one triangle.
    std::size_t boundary_edge_count() const noexcept { return boundary_edge_count_; }
    /// Edges of three triangles or more.
    std::size_t non_manifold_edge_count() const noexcept { return non_manifold_edge_count_; }
    /// Vertices in no triangle.
    std::size_t isolated_vertex_count() const noexcept { return isolated_vertex_count_; }
    /// Parts of the mesh that share no vertex; isolated vertices not counted.
    std::size_t component_count() const noexcept { return component_count_; }

    /// Pattern of G: triangles that share a vertex (consistent) or an edge (printed). Made anew at each call.
    CsrPattern csr_pattern(Matrix matrix) const;

    /// Edges of exactly two triangles: those that bending acts at. At an edge of three or more it does not, for which
    /// of them belong together is not known.
    std::size_t hinge_count() const noexcept { return edges_.size() - boundary_edge_count_ - non_manifold_edge_count_; }
    /// The hinges in the order of their edges, [hinge_count()]. Made anew at each call.
    std::vector<Hinge> hinges() const;

    /// All pairs of vertices exactly two edges apart, ascending. Made anew at each call.
    std::vector<VertexPair> second_ring_pairs() const;

private:
    Topology() = default;

    std::size_t vertex_count_ = 0;
    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> corner_offsets_;
    std::vector<Corner> corners_;
    std::vector<VertexPair> edges_;
    std::vector<std::uint32_t> edge_corner_offsets_;
    std::vector<Corner> edge_corners_;
    std::size_t boundary_edge_count_ = 0;
    std::size_t non_manifold_edge_count_ = 0;
    std::size_t isolated_vertex_count_ = 0;
    std::size_t component_count_ = 0;
};

}  // namespace apsl
