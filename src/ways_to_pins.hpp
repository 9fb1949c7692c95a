// SPDX-License-Identifier: MIT
#pragma once

#include "invalid.hpp"

#include <apsl/topology.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <span>
#include <string>
#include <tuple>
#include <vector>

// Ways over the surface from pinned vertices: what tethers are as long as.
namespace apsl {

/// Sets of pinned vertices that edges connect, numbered in the order of their first vertex.
struct PinnedPieces {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    std::vector<std::uint32_t> of_vertex;  ///< [V], none where it is not pinned or in no triangle
    std::uint32_t count = 0;
};

/// Throws Error(invalid_argument) for a pinned vertex that is none.
inline PinnedPieces pinned_pieces(const Topology& topology, std::span<const std::uint32_t> pinned) {
    constexpr std::uint32_t none = PinnedPieces::none;
    // Of each vertex one that the piece was joined from; a piece's first vertex is its own.
    std::vector<std::uint32_t> joined_to(topology.vertex_count(), none);
    for (const std::uint32_t v : pinned) {
        if (v >= topology.vertex_count())
            invalid("pinned vertex " + std::to_string(v) + ", expected one below " +
                    std::to_string(topology.vertex_count()));
        if (topology.corner_offsets()[v] < topology.corner_offsets()[v + 1]) joined_to[v] = v;
    }
    const auto first_of = [&](std::uint32_t v) {
        while (joined_to[v] != v) v = joined_to[v] = joined_to[joined_to[v]];
        return v;
    };
    for (const auto& [a, b] : topology.edges())
        if (joined_to[a] != none && joined_to[b] != none) joined_to[first_of(b)] = first_of(a);

    std::vector<std::uint32_t> number(topology.vertex_count(), none);
    PinnedPieces pieces{.of_vertex = number, .count = 0};
    for (std::uint32_t v = 0; v < number.size(); ++v) {
        if (joined_to[v] == none) continue;
        std::uint32_t& piece = number[first_of(v)];
        if (piece == none) piece = pieces.count++;
        pieces.of_vertex[v] = piece;
    }
    return pieces;
}

/// A way over the surface from a pinned vertex, its anchor.
struct Way {
    double length;  ///< m
    std::uint32_t vertex, anchor, piece;

    bool operator>(const Way& other) const {
        return std::tie(length, vertex, anchor) > std::tie(other.length, other.vertex, other.anchor);
    }
};

using Point = std::array<double, 3>;

inline Point operator-(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline double dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The straight way to `to` across the edge from `a` to `b`, from a source that is d_a and d_b away from these, all
/// unfolded into the plane of the triangle; infinite where it does not cross the edge.
inline double straight_way(const Point& a, double d_a, const Point& b, double d_b, const Point& to) {
    constexpr double no_way = std::numeric_limits<double>::infinity();
    const Point edge = b - a, side = to - a;
    const double length = std::sqrt(dot(edge, edge));
    if (!(length > 0.0)) return no_way;
    const double along = dot(side, edge) / length, across = std::sqrt(std::max(dot(side, side) - along * along, 0.0));
    const double source = (d_a * d_a - d_b * d_b + length * length) / (2.0 * length);
    const double squared_depth = d_a * d_a - source * source;
    // Rounding makes the depth of a source in line with the edge a little less than nothing.
    if (squared_depth < -1e-9 * length * length) return no_way;
    const double depth = std::sqrt(std::max(squared_depth, 0.0));
    if (!(across + depth > 0.0)) return no_way;
    const double crossing = source + (along - source) * depth / (across + depth);
    return crossing >= 0.0 && crossing <= length ? std::hypot(along - source, across + depth) : no_way;
}

/// Dijkstra's algorithm, to the nearest pieces of each vertex, with triangles unfolded into the plane of their
/// neighbours as the front passes (Novotni and Klein 2002, Computing geodesic distances on triangular meshes, WSCG).
class WaysToPins {
public:
    /// `positions`: m, [3V]. `per_vertex`: pieces a vertex has a way to, at most.
    WaysToPins(const Topology& topology, std::span<const double> positions, std::size_t per_vertex)
        : topology_(topology), positions_(positions), per_vertex_(per_vertex), found_(topology.vertex_count()) {}

    /// The nearest anchor in each of the nearest pieces, nearest first.
    const std::vector<std::vector<Way>>& find(const PinnedPieces& pieces) {
        for (std::uint32_t v = 0; v < pieces.of_vertex.size(); ++v)
            if (pieces.of_vertex[v] != PinnedPieces::none) queue_.push({0.0, v, v, pieces.of_vertex[v]});
        while (!queue_.empty()) {
            const Way way = queue_.top();
            queue_.pop();
            std::vector<Way>& found = found_[way.vertex];
            const bool known =
                std::any_of(found.begin(), found.end(), [&](const Way& other) { return other.piece == way.piece; });
            if (known || found.size() == per_vertex_) continue;
            found.push_back(way);
            go_on(way);
        }
        return found_;
    }

private:
    Point at(std::uint32_t v) const { return {positions_[3 * v], positions_[3 * v + 1], positions_[3 * v + 2]}; }

    void go_on(const Way& way) {
        const auto offsets = topology_.corner_offsets();
        for (std::uint32_t n = offsets[way.vertex]; n < offsets[way.vertex + 1]; ++n) {
            const Corner corner = topology_.corners()[n];
            const Triangle& triangle = topology_.triangles()[corner / 3];
            const std::uint32_t left = triangle[(corner + 1) % 3], right = triangle[(corner + 2) % 3];
            go_to(left, way, right);
            go_to(right, way, left);
        }
    }

    /// To `vertex`, along the edge or between it and `beside`.
    void go_to(std::uint32_t vertex, const Way& way, std::uint32_t beside) {
        const Point from = at(way.vertex), to = at(vertex), edge = to - from;
        double length = way.length + std::sqrt(dot(edge, edge));
        for (const Way& other : found_[beside])
            if (other.anchor == way.anchor)
                length = std::min(length, straight_way(from, way.length, at(beside), other.length, to));
        queue_.push({length, vertex, way.anchor, way.piece});
    }

    const Topology& topology_;
    std::span<const double> positions_;
    std::size_t per_vertex_;
    std::vector<std::vector<Way>> found_;
    std::priority_queue<Way, std::vector<Way>, std::greater<>> queue_;
};

}  // namespace apsl
