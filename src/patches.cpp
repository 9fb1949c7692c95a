// SPDX-License-Identifier: MIT
#include "patches.hpp"

#include <algorithm>
#include <limits>

namespace apsl {
namespace {

constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();

// Appends to `order` up to `budget` unplaced triangles around `seed`, breadth-first across edges' and corners'
// vertices. What it reached but did not place goes to `rim`.
class PatchGrower {
public:
    explicit PatchGrower(const Topology& topology)
        : topology_(topology),
          placed_(topology.triangle_count(), false),
          seen_in_(topology.triangle_count(), nowhere),
          passed_in_(topology.vertex_count(), nowhere),
          first_open_(topology.corner_offsets().begin(), topology.corner_offsets().end()) {
        order_.reserve(topology.triangle_count());
    }

    bool placed(std::uint32_t triangle) const { return placed_[triangle]; }
    std::vector<std::uint32_t> take_order() { return std::move(order_); }
    std::size_t placed_count() const { return order_.size(); }

    void grow(std::uint32_t seed, std::uint32_t patch, std::size_t end, std::vector<std::uint32_t>& rim) {
        queue_.assign(1, seed);
        seen_in_[seed] = patch;
        for (std::size_t next = 0; next < queue_.size(); ++next) {
            const std::uint32_t triangle = queue_[next];
            if (order_.size() == end) {
                rim.push_back(triangle);
                continue;
            }
            placed_[triangle] = true;
            order_.push_back(triangle);
            for (const std::uint32_t vertex : topology_.triangles()[triangle]) pass(vertex, patch, next + 1, end);
        }
    }

private:
    // Queues what lies around a vertex, of which `waiting_from` and later are still to be placed. Looks at each
    // triangle a few times, not once for each that it shares the vertex with: there may be a million around one.
    void pass(std::uint32_t vertex, std::uint32_t patch, std::size_t waiting_from, std::size_t end) {
        if (passed_in_[vertex] == patch) return;
        // All that is not placed is in the rim already. Behind what fills the patch it would only go there again.
        const bool in_rim = passed_in_[vertex] != nowhere;
        passed_in_[vertex] = patch;
        const std::uint32_t last = topology_.corner_offsets()[vertex + 1];
        std::uint32_t& first = first_open_[vertex];
        while (first < last && placed_[topology_.corners()[first] / 3]) ++first;
        for (std::uint32_t n = first; n < last; ++n) {
            if (in_rim && queue_.size() - waiting_from >= end - order_.size()) return;
            const std::uint32_t neighbour = topology_.corners()[n] / 3;
            if (placed_[neighbour] || seen_in_[neighbour] == patch) continue;
            seen_in_[neighbour] = patch;
            queue_.push_back(neighbour);
        }
    }

    const Topology& topology_;
    std::vector<bool> placed_;
    std::vector<std::uint32_t> seen_in_;     // the last patch, by triangle
    std::vector<std::uint32_t> passed_in_;   // the last patch that went on across a vertex
    std::vector<std::uint32_t> first_open_;  // of a vertex's corners, those before are of placed triangles
    std::vector<std::uint32_t> queue_;
    std::vector<std::uint32_t> order_;
};

}  // namespace

Patches build_patches(const Topology& topology, std::uint32_t max_triangles) {
    Patches patches;
    const auto count = static_cast<std::uint32_t>(topology.triangle_count());
    PatchGrower grower(topology);
    std::vector<std::uint32_t> rim;
    std::size_t next_in_rim = 0;
    std::uint32_t next_anywhere = 0, patch = 0;
    while (grower.placed_count() < count) {
        patches.patch_offsets.push_back(static_cast<std::uint32_t>(grower.placed_count()));
        const std::size_t end = std::min<std::size_t>(grower.placed_count() + max_triangles, count);
        // Enclosed leftovers are smaller than a patch: go on from the next seed until the patch is full.
        while (grower.placed_count() < end) {
            while (next_in_rim < rim.size() && grower.placed(rim[next_in_rim])) ++next_in_rim;
            if (next_in_rim < rim.size()) {
                grower.grow(rim[next_in_rim], patch, end, rim);
            } else {
                while (grower.placed(next_anywhere)) ++next_anywhere;
                grower.grow(next_anywhere, patch, end, rim);
            }
        }
        ++patch;
    }
    patches.patch_offsets.push_back(count);
    patches.triangle_order = grower.take_order();

    std::vector<bool> used(topology.vertex_count(), false);
    patches.vertex_order.reserve(topology.vertex_count());
    const auto valence = [&](std::uint32_t vertex) {
        return topology.corner_offsets()[vertex + 1] - topology.corner_offsets()[vertex];
    };
    const auto use = [&](std::uint32_t vertex) {
        if (!used[vertex]) patches.vertex_order.push_back(vertex);
        used[vertex] = true;
    };
    for (std::size_t p = 0; p + 1 < patches.patch_offsets.size(); ++p) {
        const auto first = static_cast<std::ptrdiff_t>(patches.vertex_order.size());
        for (std::uint32_t place = patches.patch_offsets[p]; place < patches.patch_offsets[p + 1]; ++place)
            for (const std::uint32_t vertex : topology.triangles()[patches.triangle_order[place]]) use(vertex);
        // Vertices of like valence together: a loop over a vertex's corners then ends where the processor expects it
        // to.
        std::stable_sort(patches.vertex_order.begin() + first, patches.vertex_order.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return valence(a) < valence(b); });
    }
    for (std::uint32_t vertex = 0; vertex < topology.vertex_count(); ++vertex) use(vertex);
    return patches;
}

}  // namespace apsl
