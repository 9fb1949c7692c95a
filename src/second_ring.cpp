// SPDX-License-Identifier: MIT
#include "counting_sort.hpp"

#include <apsl/topology.hpp>

#include <limits>

namespace apsl {

std::vector<VertexPair> Topology::second_ring_pairs() const {
    // Neighbours of each vertex. Edges come in ascending order, so one pass leaves every list ascending.
    std::vector<std::size_t> offsets(vertex_count_ + 1, 0);
    for (const VertexPair& edge : edges_)
        for (const std::uint32_t v : edge) ++offsets[v + 1];
    accumulate_offsets(offsets);
    std::vector<std::uint32_t> neighbours(2 * edges_.size());
    std::vector<std::size_t> next(offsets.begin(), offsets.end() - 1);
    for (const auto& [low, high] : edges_) {
        neighbours[next[low]++] = high;
        neighbours[next[high]++] = low;
    }

    // Pairs in ascending order of their greater vertex; the stable sort below orders them by the smaller one.
    std::vector<VertexPair> pairs;
    std::vector<std::uint32_t> last_seen_from(vertex_count_, std::numeric_limits<std::uint32_t>::max());
    for (std::uint32_t v = 0; v < vertex_count_; ++v) {
        last_seen_from[v] = v;
        for (std::size_t n = offsets[v]; n < offsets[v + 1]; ++n) last_seen_from[neighbours[n]] = v;
        for (std::size_t n = offsets[v]; n < offsets[v + 1]; ++n) {
            const std::uint32_t middle = neighbours[n];
            for (std::size_t m = offsets[middle]; m < offsets[middle + 1] && neighbours[m] < v; ++m) {
                const std::uint32_t u = neighbours[m];
                if (last_seen_from[u] == v) continue;
                last_seen_from[u] = v;
                pairs.push_back({u, v});
            }
        }
    }
    return counting_sort<std::size_t>(pairs, vertex_count_, [](const VertexPair& pair) { return pair[0]; }).items;
}

}  // namespace apsl
