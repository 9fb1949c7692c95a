// SPDX-License-Identifier: MIT
//
// Constraints lie in blocks of four that share no vertex, color after color, and a vertex in one register of four
// lanes, the last of them 0: a block loads its eight vertices, and all but the way from and to memory is done for four
// constraints at once. A color that four do not divide is filled up with constraints between vertices that nobody sees.
#include "methods/tethered_distances.hpp"

#include "methods/edge_constraints.hpp"
#include "methods/greedy_coloring.hpp"
#include "methods/parameter_values.hpp"
#include "methods/unfolded_distances.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace apsl::methods {
namespace {

using Lanes = float __attribute__((vector_size(16)));

struct Vertex {
    Lanes at;  // x, y, z, 0
};

constexpr std::size_t block_size = 4;
constexpr float least_square = 1e-24f;  // m², keeps the inverse of a length finite

Lanes all(float value) {
    return Lanes{value, value, value, value};
}

template <int lane>
Lanes broadcast(Lanes from) {
    return __builtin_shufflevector(from, from, lane, lane, lane, lane);
}

// 1 / √x for x ≥ least_square, to about two units in the last place.
Lanes inverse_square_root(Lanes x) {
#ifdef __SSE__
    const Lanes guess = _mm_rsqrt_ps(x);
    return guess * (all(1.5f) - all(0.5f) * x * guess * guess);
#else
    for (std::size_t lane = 0; lane < block_size; ++lane) x[lane] = 1.0f / std::sqrt(x[lane]);
    return x;
#endif
}

// |d|² of four vectors.
Lanes squares(Lanes d0, Lanes d1, Lanes d2, Lanes d3) {
    const Lanes low01 = __builtin_shufflevector(d0 * d0, d1 * d1, 0, 4, 1, 5);
    const Lanes high01 = __builtin_shufflevector(d0 * d0, d1 * d1, 2, 6, 3, 7);
    const Lanes low23 = __builtin_shufflevector(d2 * d2, d3 * d3, 0, 4, 1, 5);
    const Lanes high23 = __builtin_shufflevector(d2 * d2, d3 * d3, 2, 6, 3, 7);
    const Lanes sum01 = low01 + high01;  // x + z and y + 0 of two vectors
    const Lanes sum23 = low23 + high23;
    return __builtin_shufflevector(sum01, sum23, 0, 1, 4, 5) + __builtin_shufflevector(sum01, sum23, 2, 3, 6, 7);
}

struct DistanceBlock {
    std::array<std::uint32_t, block_size> from, to;
    Lanes rest;   // m
    Lanes share;  // w_from / (w_from + w_to)
};

struct TetherBlock {
    std::array<std::uint32_t, block_size> vertices, pins;
    Lanes length;  // m
};

void relax(const DistanceBlock& block, Lanes stiffness, Vertex* vertices) {
    Vertex& a0 = vertices[block.from[0]];
    Vertex& a1 = vertices[block.from[1]];
    Vertex& a2 = vertices[block.from[2]];
    Vertex& a3 = vertices[block.from[3]];
    Vertex& b0 = vertices[block.to[0]];
    Vertex& b1 = vertices[block.to[1]];
    Vertex& b2 = vertices[block.to[2]];
    Vertex& b3 = vertices[block.to[3]];
    const Lanes d0 = b0.at - a0.at;
    const Lanes d1 = b1.at - a1.at;
    const Lanes d2 = b2.at - a2.at;
    const Lanes d3 = b3.at - a3.at;
    const Lanes inverse_length = inverse_square_root(squares(d0, d1, d2, d3) + all(least_square));
    const Lanes error = stiffness * (all(1.0f) - block.rest * inverse_length);
    const Lanes of_from = block.share * error;
    const Lanes of_to = error - of_from;
    a0.at += broadcast<0>(of_from) * d0;
    a1.at += broadcast<1>(of_from) * d1;
    a2.at += broadcast<2>(of_from) * d2;
    a3.at += broadcast<3>(of_from) * d3;
    b0.at -= broadcast<0>(of_to) * d0;
    b1.at -= broadcast<1>(of_to) * d1;
    b2.at -= broadcast<2>(of_to) * d2;
    b3.at -= broadcast<3>(of_to) * d3;
}

void relax(const TetherBlock& block, Vertex* vertices) {
    const Lanes p0 = vertices[block.pins[0]].at;
    const Lanes p1 = vertices[block.pins[1]].at;
    const Lanes p2 = vertices[block.pins[2]].at;
    const Lanes p3 = vertices[block.pins[3]].at;
    Vertex& v0 = vertices[block.vertices[0]];
    Vertex& v1 = vertices[block.vertices[1]];
    Vertex& v2 = vertices[block.vertices[2]];
    Vertex& v3 = vertices[block.vertices[3]];
    const Lanes d0 = v0.at - p0;
    const Lanes d1 = v1.at - p1;
    const Lanes d2 = v2.at - p2;
    const Lanes d3 = v3.at - p3;
    const Lanes square = squares(d0, d1, d2, d3);
    const auto beyond = square > block.length * block.length;
    if ((beyond[0] | beyond[1] | beyond[2] | beyond[3]) == 0) return;
    const Lanes to_length = block.length * inverse_square_root(square + all(least_square));
    const Lanes scale = beyond ? to_length : all(1.0f);
    v0.at = p0 + broadcast<0>(scale) * d0;
    v1.at = p1 + broadcast<1>(scale) * d1;
    v2.at = p2 + broadcast<2>(scale) * d2;
    v3.at = p3 + broadcast<3>(scale) * d3;
}

// The distances of the two vertices opposite each inner edge. Each pair once: two edges may have the same two.
std::vector<EdgeConstraint> bending_constraints(const Cloth& cloth) {
    const Topology& topology = *cloth.topology;
    std::vector<VertexPair> pairs;
    for (std::size_t e = 0; e < topology.edges().size(); ++e) {
        const std::uint32_t first = topology.edge_corner_offsets()[e];
        const std::uint32_t end = topology.edge_corner_offsets()[e + 1];
        for (std::uint32_t i = first; i + 1 < end; ++i) {
            const auto vertex_of = [&](Corner corner) { return topology.triangles()[corner / 3][corner % 3]; };
            const std::uint32_t a = vertex_of(topology.edge_corners()[i]);
            const std::uint32_t b = vertex_of(topology.edge_corners()[i + 1]);
            if (a != b) pairs.push_back({std::min(a, b), std::max(a, b)});
        }
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return distance_constraints(cloth, pairs);
}

// `unseen`: the first of 2 block_size vertices that fill blocks up.
std::vector<DistanceBlock> distance_blocks(std::vector<EdgeConstraint> constraints, std::uint32_t unseen) {
    const Coloring coloring = sort_by_color(constraints, unseen, &EdgeConstraint::vertices);
    std::vector<DistanceBlock> blocks;
    for (std::size_t color = 0; color < coloring.color_count(); ++color) {
        for (std::size_t first = coloring.offsets[color]; first < coloring.offsets[color + 1]; first += block_size) {
            DistanceBlock block{};
            for (std::size_t lane = 0; lane < block_size; ++lane) {
                block.from[lane] = unseen + static_cast<std::uint32_t>(2 * lane);
                block.to[lane] = block.from[lane] + 1;
                if (first + lane >= coloring.offsets[color + 1]) continue;
                const EdgeConstraint& constraint = constraints[first + lane];
                const auto [w_from, w_to] = constraint.inverse_masses;
                block.from[lane] = constraint.vertices[0];
                block.to[lane] = constraint.vertices[1];
                block.rest[lane] = constraint.rest_length;
                block.share[lane] = w_from / (w_from + w_to);
            }
            blocks.push_back(block);
        }
    }
    return blocks;
}

std::vector<TetherBlock> tether_blocks(const Cloth& cloth, double length_factor, std::uint32_t unseen) {
    std::vector<TetherBlock> blocks;
    if (length_factor == 0.0) return blocks;
    for (const std::vector<PinDistance>& island : unfolded_distances(cloth)) {
        for (std::size_t first = 0; first < island.size(); first += block_size) {
            TetherBlock block{};
            for (std::size_t lane = 0; lane < block_size; ++lane) {
                block.vertices[lane] = block.pins[lane] = unseen + static_cast<std::uint32_t>(lane);
                if (first + lane >= island.size()) continue;
                const PinDistance& way = island[first + lane];
                block.vertices[lane] = way.vertex;
                block.pins[lane] = way.pin;
                block.length[lane] = static_cast<float>(length_factor * way.length);
            }
            blocks.push_back(block);
        }
    }
    return blocks;
}

Lanes lanes_of(const Eigen::Vector3f& vector) {
    return Lanes{vector.x(), vector.y(), vector.z(), 0.0f};
}

Eigen::Vector3f vector_of(Lanes lanes) {
    return {lanes[0], lanes[1], lanes[2]};
}

}  // namespace

struct TetheredDistances::Implementation {
    int steps;
    float step_length;  // s
    Lanes bending;
    std::vector<DistanceBlock> bends, edges;
    std::vector<TetherBlock> tethers;
    // [V], of a small step: the part of its motion that a vertex keeps, and what gravity moves it by.
    std::vector<float> kept;
    std::vector<Vertex> pushes;
    std::vector<Vertex> now;        // [V + 2 block_size]
    std::vector<Vertex> predicted;  // [V], where the last small step went before its constraints
    // [V], what the last small step moved by, before its constraints. Differences of positions alone would round
    // gravity's part away: it is no more than their last place in a small step.
    std::vector<Vertex> motions;

    Lanes motion(std::size_t v) const { return motions[v].at + (now[v].at - predicted[v].at); }

    void take_step() {
        for (std::size_t v = 0; v < kept.size(); ++v) {
            motions[v].at = all(kept[v]) * motion(v) + pushes[v].at;
            now[v].at += motions[v].at;
            predicted[v].at = now[v].at;
        }
        for (const TetherBlock& block : tethers) relax(block, now.data());
        for (const DistanceBlock& block : bends) relax(block, bending, now.data());
        for (const DistanceBlock& block : edges) relax(block, all(1.0f), now.data());
    }
};

TetheredDistances::TetheredDistances(const Cloth& cloth, const TetherSettings& settings) {
    constexpr double greatest = std::numeric_limits<float>::max();
    require_between("steps", settings.steps, 1.0, 1e6);
    require_between("tether_length", settings.tether_length, 0.0, 1e6);
    require_between("bending", settings.bending, 0.0, 1.0);
    require_between("damping", settings.damping, 0.0, greatest);
    const auto unseen = static_cast<std::uint32_t>(cloth.rest_positions.size());
    const double step_length = cloth.time_step / settings.steps;
    implementation_ = std::make_unique<Implementation>(
        Implementation{.steps = settings.steps,
                       .step_length = static_cast<float>(step_length),
                       .bending = all(static_cast<float>(settings.bending)),
                       .bends = settings.bending > 0.0 ? distance_blocks(bending_constraints(cloth), unseen)
                                                       : std::vector<DistanceBlock>(),
                       .edges = distance_blocks(edge_constraints(cloth), unseen),
                       .tethers = tether_blocks(cloth, settings.tether_length, unseen),
                       .kept = std::vector<float>(unseen, 1.0f),
                       .pushes = std::vector<Vertex>(unseen, Vertex{all(0.0f)}),
                       .now = std::vector<Vertex>(unseen + 2 * block_size, Vertex{all(0.0f)}),
                       .predicted = std::vector<Vertex>(unseen, Vertex{all(0.0f)}),
                       .motions = std::vector<Vertex>(unseen, Vertex{all(0.0f)})});
    const Eigen::Vector3f push = (step_length * step_length * settings.gravity).cast<float>();
    for (std::size_t v = 0; v < unseen; ++v) {
        if (cloth.inverse_masses[v] == 0.0) continue;
        implementation_->kept[v] = static_cast<float>(std::exp(-settings.damping * step_length));
        implementation_->pushes[v].at = lanes_of(push);
    }
}

TetheredDistances::~TetheredDistances() = default;
TetheredDistances::TetheredDistances(TetheredDistances&&) noexcept = default;
TetheredDistances& TetheredDistances::operator=(TetheredDistances&&) noexcept = default;

void TetheredDistances::advance(std::span<Eigen::Vector3f> positions, std::span<Eigen::Vector3f> velocities) {
    Implementation& cloth = *implementation_;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        cloth.now[v].at = cloth.predicted[v].at = lanes_of(positions[v]);
        cloth.motions[v].at = all(cloth.step_length) * lanes_of(velocities[v]);
    }
    for (int step = 0; step < cloth.steps; ++step) cloth.take_step();
    for (std::size_t v = 0; v < positions.size(); ++v) {
        positions[v] = vector_of(cloth.now[v].at);
        velocities[v] = vector_of(cloth.motion(v) / all(cloth.step_length));
    }
}

}  // namespace apsl::methods
