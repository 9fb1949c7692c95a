// SPDX-License-Identifier: MIT
#include "counting_sort.hpp"
#include "mesh_size.hpp"

#include <apsl/error.hpp>
#include <apsl/topology.hpp>

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace apsl {
namespace {

std::string describe(std::size_t a, const Triangle& triangle) {
    return "triangle " + std::to_string(a) + " (" + std::to_string(triangle[0]) + ", " + std::to_string(triangle[1]) +
           ", " + std::to_string(triangle[2]) + ")";
}

void check_mesh(std::span<const Triangle> triangles, std::size_t vertex_count) {
    check_mesh_size(triangles.size(), vertex_count);
    for (std::size_t a = 0; a < triangles.size(); ++a) {
        const Triangle& t = triangles[a];
        for (const std::uint32_t v : t)
            if (v >= vertex_count)
                throw Error(ErrorCode::invalid_mesh, describe(a, t) + " names vertex " + std::to_string(v) +
                                                         ", expected an index below the vertex count " +
                                                         std::to_string(vertex_count));
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
            throw Error(ErrorCode::invalid_mesh,
                        describe(a, t) + " names a vertex twice, expected three different vertices");
    }
}

std::uint32_t vertex_of(std::span<const Triangle> triangles, Corner corner) {
    return triangles[corner / 3][corner % 3];
}

VertexPair opposite_edge(std::span<const Triangle> triangles, Corner corner) {
    const Triangle& t = triangles[corner / 3];
    const std::uint32_t k = corner % 3;
    const auto [low, high] = std::minmax(t[(k + 1) % 3], t[(k + 2) % 3]);
    return {low, high};
}

std::size_t count_components(std::span<const Triangle> triangles, std::span<const std::uint32_t> corner_offsets,
                             std::span<const Corner> corners) {
    const std::size_t vertex_count = corner_offsets.size() - 1;
    std::vector<bool> reached(vertex_count, false);
    std::vector<std::uint32_t> open;
    std::size_t components = 0;
    for (std::uint32_t seed = 0; seed < vertex_count; ++seed) {
        if (reached[seed] || corner_offsets[seed] == corner_offsets[seed + 1]) continue;
        ++components;
        reached[seed] = true;
        open.push_back(seed);
        while (!open.empty()) {
            const std::uint32_t v = open.back();
            open.pop_back();
            for (std::uint32_t c = corner_offsets[v]; c < corner_offsets[v + 1]; ++c)
                for (const std::uint32_t u : triangles[corners[c] / 3])
                    if (!reached[u]) {
                        reached[u] = true;
                        open.push_back(u);
                    }
        }
    }
    return components;
}

}  // namespace

std::shared_ptr<const Topology> Topology::build(std::span<const Triangle> triangles, std::size_t vertex_count) {
    check_mesh(triangles, vertex_count);

    // No make_shared: the constructor is private.
    const std::shared_ptr<Topology> topology(new Topology);
    topology->vertex_count_ = vertex_count;
    topology->triangles_.assign(triangles.begin(), triangles.end());

    std::vector<Corner> all_corners(3 * triangles.size());
    std::iota(all_corners.begin(), all_corners.end(), Corner{0});
    auto by_vertex =
        counting_sort<std::uint32_t>(all_corners, vertex_count, [&](Corner c) { return vertex_of(triangles, c); });
    topology->corner_offsets_ = std::move(by_vertex.offsets);
    topology->corners_ = std::move(by_vertex.items);

    // Two stable passes, least significant key first: corners in the order of the edge opposite them.
    auto by_high = counting_sort<std::uint32_t>(all_corners, vertex_count,
                                                [&](Corner c) { return opposite_edge(triangles, c)[1]; });
    auto by_edge = counting_sort<std::uint32_t>(by_high.items, vertex_count,
                                                [&](Corner c) { return opposite_edge(triangles, c)[0]; });
    topology->edge_corners_ = std::move(by_edge.items);
    for (std::uint32_t position = 0; const Corner corner : topology->edge_corners_) {
        const VertexPair edge = opposite_edge(triangles, corner);
        if (topology->edges_.empty() || topology->edges_.back() != edge) {
            topology->edges_.push_back(edge);
            topology->edge_corner_offsets_.push_back(position);
        }
        ++position;
    }
    topology->edges_.shrink_to_fit();
    topology->edge_corner_offsets_.push_back(static_cast<std::uint32_t>(topology->edge_corners_.size()));

    for (std::size_t e = 0; e < topology->edges_.size(); ++e) {
        const std::uint32_t count = topology->edge_corner_offsets_[e + 1] - topology->edge_corner_offsets_[e];
        if (count == 1) ++topology->boundary_edge_count_;
        if (count > 2) ++topology->non_manifold_edge_count_;
    }
    for (std::size_t v = 0; v < vertex_count; ++v)
        if (topology->corner_offsets_[v] == topology->corner_offsets_[v + 1]) ++topology->isolated_vertex_count_;
    topology->component_count_ = count_components(triangles, topology->corner_offsets_, topology->corners_);
    return topology;
}

}  // namespace apsl
