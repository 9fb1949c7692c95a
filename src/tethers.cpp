// SPDX-License-Identifier: MIT
#include "fields.hpp"
#include "finite.hpp"
#include "invalid.hpp"

#include <apsl/tethers.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <string>
#include <tuple>

namespace apsl {
namespace {

using Point = std::array<double, 3>;

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

Point operator-(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The pinned piece of each vertex, [V]; `none` where it is not pinned or in no triangle.
std::vector<std::uint32_t> pinned_pieces(const Topology& topology, std::span<const std::uint32_t> pinned) {
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

    std::vector<std::uint32_t> number(topology.vertex_count(), none), pieces = number;
    std::uint32_t count = 0;
    for (std::uint32_t v = 0; v < pieces.size(); ++v) {
        if (joined_to[v] == none) continue;
        std::uint32_t& piece = number[first_of(v)];
        if (piece == none) piece = count++;
        pieces[v] = piece;
    }
    return pieces;
}

/// A way over the surface from a pinned vertex.
struct Way {
    double length;  ///< m
    std::uint32_t vertex, anchor, piece;

    bool operator>(const Way& other) const {
        return std::tie(length, vertex, anchor) > std::tie(other.length, other.vertex, other.anchor);
    }
};

/// The straight way to `to` across the edge from `a` to `b`, from a source that is d_a and d_b away from these, all
/// unfolded into the plane of the triangle; infinite where it does not cross the edge.
double straight_way(const Point& a, double d_a, const Point& b, double d_b, const Point& to) {
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

/// Dijkstra's algorithm, to the nearest pieces of each vertex.
class Ways {
public:
    Ways(const Topology& topology, std::span<const float> positions, std::uint32_t per_vertex)
        : topology_(topology), positions_(positions), per_vertex_(per_vertex), found_(topology.vertex_count()) {}

    /// The nearest anchor in each of the nearest pieces, nearest first.
    const std::vector<std::vector<Way>>& find(const std::vector<std::uint32_t>& pieces) {
        for (std::uint32_t v = 0; v < pieces.size(); ++v)
            if (pieces[v] != none) queue_.push({0.0, v, v, pieces[v]});
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
    std::span<const float> positions_;
    std::size_t per_vertex_;
    std::vector<std::vector<Way>> found_;
    std::priority_queue<Way, std::vector<Way>, std::greater<>> queue_;
};

}  // namespace

std::size_t pinned_piece_count(const Topology& topology, std::span<const std::uint32_t> pinned) {
    std::uint32_t count = 0;
    for (const std::uint32_t piece : pinned_pieces(topology, pinned))
        if (piece != none) count = std::max(count, piece + 1);
    return count;
}

Tethers tethers_to_pins(const Topology& topology, std::span<const float> rest_positions,
                        std::span<const std::uint32_t> pinned, std::uint32_t per_vertex, float stretch) {
    if (rest_positions.size() != 3 * topology.vertex_count())
        invalid("rest_positions holds " + std::to_string(rest_positions.size()) + " numbers, expected " +
                std::to_string(3 * topology.vertex_count()));
    for (std::size_t n = 0; n < rest_positions.size(); ++n)
        if (!is_finite(rest_positions[n]))
            invalid("rest_positions of vertex " + std::to_string(n / 3) +
                    " is not finite, expected finite numbers (m)");
    if (per_vertex == 0 || per_vertex > most_tethers)
        invalid("per_vertex is " + std::to_string(per_vertex) + ", expected a whole number from 1 to " +
                std::to_string(most_tethers));
    if (!is_finite(stretch) || !(stretch > 0.0f))
        invalid("stretch is " + std::to_string(stretch) + ", expected a finite number > 0");

    const std::vector<std::uint32_t> pieces = pinned_pieces(topology, pinned);
    Ways ways(topology, rest_positions, per_vertex);
    const std::vector<std::vector<Way>>& found = ways.find(pieces);
    Tethers tethers{std::vector<std::uint32_t>(per_vertex * pieces.size(), 0),
                    std::vector<float>(per_vertex * pieces.size(), 0.0f)};
    for (std::size_t v = 0; v < pieces.size(); ++v) {
        if (pieces[v] != none) continue;
        for (std::size_t k = 0; k < found[v].size(); ++k) {
            tethers.anchors[per_vertex * v + k] = found[v][k].anchor;
            // A way that no float holds is no tether.
            const double length = static_cast<double>(stretch) * found[v][k].length;
            if (length <= static_cast<double>(std::numeric_limits<float>::max()))
                tethers.lengths[per_vertex * v + k] = static_cast<float>(length);
        }
    }
    return tethers;
}

}  // namespace apsl
