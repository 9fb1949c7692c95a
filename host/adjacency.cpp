// SPDX-License-Identifier: MIT
#include "adjacency.hpp"

#include "patches.hpp"

#include <apsl/error.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace apsl::host {
namespace {

std::uint32_t index(std::size_t value, std::size_t limit, const char* what) {
    if (value > limit)
        throw Error(ErrorCode::invalid_argument, "the cloths together have " + std::to_string(value) + " " + what +
                                                     ", expected at most " + std::to_string(limit));
    return static_cast<std::uint32_t>(value);
}

constexpr std::size_t max_index = std::numeric_limits<std::uint32_t>::max();

// Where each vertex and triangle of a topology is placed.
struct Places {
    std::vector<std::uint32_t> of_vertex, of_triangle;
};

std::vector<std::uint32_t> inverse(const std::vector<std::uint32_t>& order) {
    std::vector<std::uint32_t> places(order.size());
    for (std::uint32_t place = 0; place < order.size(); ++place) places[order[place]] = place;
    return places;
}

void append_pattern(Adjacency& out, const Topology& topology, const Patches& patches, const Places& places,
                    Matrix matrix, const apslk_cloth& cloth) {
    const CsrPattern pattern = topology.csr_pattern(matrix);
    index(out.columns.size() + pattern.columns.size(), max_index, "matrix entries");
    for (const std::uint32_t triangle : patches.triangle_order) {
        for (std::uint32_t e = pattern.row_offsets[triangle]; e < pattern.row_offsets[triangle + 1]; ++e) {
            out.columns.push_back(cloth.triangle_begin + places.of_triangle[pattern.columns[e]]);
            out.shared.push_back(pattern.shared[e]);
        }
        out.row_offsets.push_back(static_cast<std::uint32_t>(out.columns.size()));
    }
}

void append_patches(Adjacency& out, const Patches& patches, const apslk_cloth& cloth) {
    std::vector<std::uint32_t> local(cloth.vertex_count, 0), seen(cloth.vertex_count, max_index);
    for (std::uint32_t patch = 0; patch + 1 < patches.patch_offsets.size(); ++patch) {
        const auto first_vertex = static_cast<std::uint32_t>(out.patch_vertices.size());
        out.patches.push_back({{cloth.triangle_begin + patches.patch_offsets[patch], first_vertex}});
        for (std::uint32_t t = patches.patch_offsets[patch]; t < patches.patch_offsets[patch + 1]; ++t)
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t vertex = out.triangles[3 * (cloth.triangle_begin + t) + k];
                if (seen[vertex - cloth.vertex_begin] == patch) continue;
                seen[vertex - cloth.vertex_begin] = patch;
                out.patch_vertices.push_back(vertex);
            }
        // Ordered as the vertices are: a patch's own ones in sequence, with like valence together.
        const auto valence = [&](std::uint32_t vertex) {
            return out.corner_offsets[vertex + 1] - out.corner_offsets[vertex];
        };
        std::sort(
            out.patch_vertices.begin() + first_vertex, out.patch_vertices.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::pair(valence(a), a) < std::pair(valence(b), b); });
        for (std::uint32_t n = first_vertex; n < out.patch_vertices.size(); ++n)
            local[out.patch_vertices[n] - cloth.vertex_begin] = n - first_vertex;
        for (std::uint32_t t = patches.patch_offsets[patch]; t < patches.patch_offsets[patch + 1]; ++t)
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t n = 3 * (cloth.triangle_begin + t) + k;
                out.local_triangles[n] = static_cast<std::uint16_t>(local[out.triangles[n] - cloth.vertex_begin]);
            }
        out.max_patch_vertices =
            std::max(out.max_patch_vertices, static_cast<std::uint32_t>(out.patch_vertices.size()) - first_vertex);
    }
    out.patches.push_back(
        {{cloth.triangle_begin + cloth.triangle_count, static_cast<std::uint32_t>(out.patch_vertices.size())}});
}

// In the order of their least place, so that neighbours in memory share vertices.
void append_hinges(Adjacency& out, const Topology& topology, const Places& places, const apslk_cloth& cloth) {
    const std::vector<Hinge> given = topology.hinges();
    const auto place = [&](std::uint32_t vertex) { return cloth.vertex_begin + places.of_vertex[vertex]; };
    std::vector<cl_uint4> placed(given.size());
    std::vector<std::uint32_t> order(given.size());
    for (std::uint32_t h = 0; h < given.size(); ++h) {
        placed[h] = {{place(given[h][0]), place(given[h][1]), place(given[h][2]), place(given[h][3])}};
        order[h] = h;
    }
    const auto least = [&](std::uint32_t h) { return *std::min_element(placed[h].s, placed[h].s + 4); };
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return std::pair(least(a), a) < std::pair(least(b), b); });
    // Two bits of a hinge's corner hold its number.
    const std::uint32_t first = out.hinge_offsets.back();
    out.hinge_offsets.push_back(index(out.hinges.size() + given.size(), max_index / 4, "hinges"));
    std::vector<std::vector<std::uint32_t>> at_vertex(cloth.vertex_count);
    for (const std::uint32_t h : order) {
        const auto r = static_cast<std::uint32_t>(out.hinges.size());
        for (std::uint32_t n = 0; n < 4; ++n) at_vertex[placed[h].s[n] - cloth.vertex_begin].push_back(4 * r + n);
        out.hinges.push_back(placed[h]);
        out.hinge_order.push_back(first + h);
    }
    for (const std::vector<std::uint32_t>& corners : at_vertex) {
        out.hinge_corners.insert(out.hinge_corners.end(), corners.begin(), corners.end());
        out.hinge_corner_offsets.push_back(static_cast<std::uint32_t>(out.hinge_corners.size()));
    }
}

}  // namespace

Adjacency build_adjacency(std::span<const std::shared_ptr<const Topology>> cloths, Matrix matrix, bool with_pattern,
                          bool with_hinges, std::uint32_t patch_triangles) {
    Adjacency out;
    out.corner_offsets.push_back(0);
    if (with_hinges) {
        out.hinge_offsets.push_back(0);
        out.hinge_corner_offsets.push_back(0);
    }
    if (with_pattern) out.row_offsets.push_back(0);
    std::size_t vertices = 0, triangles = 0, rest_areas = 0;
    for (const auto& topology : cloths) {
        apslk_cloth cloth{};
        cloth.vertex_begin = index(vertices, max_index, "vertices");
        cloth.vertex_count = index(topology->vertex_count(), max_index, "vertices");
        // Two bits of a corner hold its number.
        cloth.triangle_begin = index(triangles, max_index / 4, "triangles");
        cloth.triangle_count = index(topology->triangle_count(), max_index / 4, "triangles");
        const auto first_rest_area = index(rest_areas, max_index, "triangles");
        cloth.rest_area_begin = first_rest_area;

        const Patches patches = build_patches(*topology, patch_triangles);
        const Places places{inverse(patches.vertex_order), inverse(patches.triangle_order)};
        for (const std::uint32_t vertex : patches.vertex_order) {
            out.vertex_order.push_back(cloth.vertex_begin + vertex);
            const auto corners =
                topology->corners().subspan(topology->corner_offsets()[vertex], topology->corner_offsets()[vertex + 1] -
                                                                                    topology->corner_offsets()[vertex]);
            for (const Corner corner : corners)
                out.corners.push_back(4 * (cloth.triangle_begin + places.of_triangle[corner / 3]) + corner % 3);
            out.corner_offsets.push_back(static_cast<std::uint32_t>(out.corners.size()));
        }
        for (const std::uint32_t triangle : patches.triangle_order) {
            out.triangle_order.push_back(first_rest_area + triangle);
            for (const std::uint32_t vertex : topology->triangles()[triangle])
                out.triangles.push_back(cloth.vertex_begin + places.of_vertex[vertex]);
        }
        if (with_hinges) append_hinges(out, *topology, places, cloth);
        if (with_pattern) append_pattern(out, *topology, patches, places, matrix, cloth);

        vertices += topology->vertex_count();
        rest_areas += topology->triangle_count();
        triangles += topology->triangle_count();
        constexpr std::size_t alignment = APSLK_TRIANGLE_ALIGNMENT;
        triangles = (triangles + alignment - 1) / alignment * alignment;
        // Padding names a vertex of the cloth itself, so that it is as finite as the cloth.
        out.triangles.resize(3 * triangles, cloth.vertex_begin);
        out.triangle_order.resize(triangles, 0);
        out.local_triangles.resize(3 * triangles, 0);
        if (with_pattern) out.row_offsets.resize(triangles + 1, out.row_offsets.back());
        cloth.patch_begin = static_cast<apslk_uint>(out.patches.size());
        append_patches(out, patches, cloth);
        cloth.patch_count = static_cast<apslk_uint>(out.patches.size()) - cloth.patch_begin - 1;
        out.cloths.push_back(cloth);
    }
    out.vertex_count = index(vertices, max_index, "vertices");
    out.triangle_count = index(triangles, max_index / 4, "triangles");
    for (apslk_cloth& cloth : out.cloths) cloth.run = out.triangle_count;
    out.rest_area_count = index(rest_areas, max_index, "triangles");
    return out;
}

}  // namespace apsl::host
