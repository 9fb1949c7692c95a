// SPDX-License-Identifier: MIT
#include "methods/coarsening.hpp"

#include <algorithm>

namespace apsl::methods {

namespace {

constexpr std::uint32_t least_coarse_neighbors = 2;

using Neighbors = std::vector<std::vector<std::uint32_t>>;

Neighbors neighbors(const std::vector<VertexPair>& edges, std::size_t vertex_count) {
    Neighbors result(vertex_count);
    for (const auto& [i, j] : edges) {
        result[i].push_back(j);
        result[j].push_back(i);
    }
    return result;
}

/// Which vertices the next level lacks.
std::vector<bool> choose_fine(const Cloth& cloth, const Level& level, const Neighbors& around) {
    std::vector<bool> fine(around.size());
    std::vector<std::uint32_t> coarse_neighbors(around.size());
    for (std::size_t v = 0; v < around.size(); ++v) coarse_neighbors[v] = static_cast<std::uint32_t>(around[v].size());
    for (const std::uint32_t vertex : level.vertices) {
        const bool can_spare = std::ranges::all_of(around[vertex], [&](std::uint32_t neighbor) {
            return !fine[neighbor] || coarse_neighbors[neighbor] > least_coarse_neighbors;
        });
        if (cloth.inverse_masses[vertex] == 0.0 || coarse_neighbors[vertex] < least_coarse_neighbors || !can_spare)
            continue;
        fine[vertex] = true;
        for (const std::uint32_t neighbor : around[vertex]) --coarse_neighbors[neighbor];
    }
    return fine;
}

double distance(const Cloth& cloth, std::uint32_t i, std::uint32_t j) {
    return (cloth.rest_positions[j] - cloth.rest_positions[i]).norm();
}

/// Parents and weights of the fine vertices; returns for every vertex where the next level sees it.
std::vector<std::uint32_t> set_parents(const Cloth& cloth, const Neighbors& around, const std::vector<bool>& fine,
                                       Level& level) {
    std::vector<std::uint32_t> seen_at(around.size());
    for (const std::uint32_t vertex : level.vertices) {
        seen_at[vertex] = vertex;
        if (!fine[vertex]) continue;
        double sum = 0.0;
        double nearest = 0.0;
        std::vector<double> inverse_distances;
        for (const std::uint32_t parent : around[vertex]) {
            if (fine[parent]) continue;
            // Vertices that lie on one another at rest: as near as 32 bits can tell them apart from the rest.
            const double inverse_distance = 1.0 / std::max(distance(cloth, vertex, parent), 1e-9);
            inverse_distances.push_back(inverse_distance);
            sum += inverse_distance;
            level.parents.push_back(parent);
            if (inverse_distance > nearest) seen_at[vertex] = parent;
            nearest = std::max(nearest, inverse_distance);
        }
        for (const double inverse_distance : inverse_distances)
            level.weights.push_back(static_cast<float>(inverse_distance / sum));
        level.fine_vertices.push_back(vertex);
        level.parent_offsets.push_back(static_cast<std::uint32_t>(level.parents.size()));
    }
    return seen_at;
}

void set_rest_lengths(const Cloth& cloth, Level& level) {
    for (const auto& [i, j] : level.edges) level.rest_lengths.push_back(static_cast<float>(distance(cloth, i, j)));
}

}  // namespace

std::vector<Level> coarsen(const Cloth& cloth, int level_count) {
    const Topology& topology = *cloth.topology;
    std::vector<Level> levels(1);
    for (std::uint32_t v = 0; v < topology.vertex_count(); ++v) levels[0].vertices.push_back(v);
    levels[0].edges.assign(topology.edges().begin(), topology.edges().end());
    set_rest_lengths(cloth, levels[0]);
    while (static_cast<int>(levels.size()) < level_count) {
        Level& level = levels.back();
        const Neighbors around = neighbors(level.edges, topology.vertex_count());
        const std::vector<bool> fine = choose_fine(cloth, level, around);
        const std::vector<std::uint32_t> seen_at = set_parents(cloth, around, fine, level);
        if (level.fine_vertices.empty()) break;
        Level coarser;
        std::ranges::copy_if(level.vertices, std::back_inserter(coarser.vertices),
                             [&](std::uint32_t vertex) { return !fine[vertex]; });
        for (const auto& [i, j] : level.edges) {
            const auto [first, last] = std::minmax(seen_at[i], seen_at[j]);
            if (first != last) coarser.edges.push_back({first, last});
        }
        std::ranges::sort(coarser.edges);
        const auto duplicates = std::ranges::unique(coarser.edges);
        coarser.edges.erase(duplicates.begin(), duplicates.end());
        set_rest_lengths(cloth, coarser);
        levels.push_back(std::move(coarser));
    }
    return levels;
}

void interpolate(const Level& level, std::span<const Eigen::Vector3f> before, std::span<Eigen::Vector3f> positions) {
    const auto count = static_cast<std::int64_t>(level.fine_vertices.size());
#pragma omp parallel for schedule(static)
    for (std::int64_t n = 0; n < count; ++n) {
        Eigen::Vector3f correction = Eigen::Vector3f::Zero();
        for (std::uint32_t p = level.parent_offsets[n]; p < level.parent_offsets[n + 1]; ++p) {
            const std::uint32_t parent = level.parents[p];
            correction += level.weights[p] * (positions[parent] - before[parent]);
        }
        positions[level.fine_vertices[n]] += correction;
    }
}

}  // namespace apsl::methods
