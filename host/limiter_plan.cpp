// SPDX-License-Identifier: MIT
#include "limiter_plan.hpp"

#include <apsl/error.hpp>

#include <limits>

namespace apsl::host {
namespace {

std::uint32_t index(std::size_t value, std::size_t limit, const char* what) {
    if (value > limit)
        throw Error(ErrorCode::invalid_argument, "the cloths together have " + std::to_string(value) + " " + what +
                                                     ", expected at most " + std::to_string(limit));
    return static_cast<std::uint32_t>(value);
}

constexpr std::size_t max_index = std::numeric_limits<std::uint32_t>::max();

void append_pattern(Adjacency& out, const Topology& topology, Matrix matrix, const apsl_cloth& cloth) {
    const CsrPattern pattern = topology.csr_pattern(matrix);
    const std::size_t first_entry = out.columns.size();
    index(first_entry + pattern.columns.size(), max_index, "matrix entries");
    for (std::size_t a = 0; a < topology.triangle_count(); ++a)
        out.row_offsets.push_back(static_cast<std::uint32_t>(first_entry + pattern.row_offsets[a + 1]));
    for (const std::uint32_t column : pattern.columns) out.columns.push_back(cloth.triangle_begin + column);
    out.shared.insert(out.shared.end(), pattern.shared.begin(), pattern.shared.end());
}

}  // namespace

Adjacency build_adjacency(std::span<const std::shared_ptr<const Topology>> cloths, Matrix matrix, bool with_pattern) {
    Adjacency out;
    out.corner_offsets.push_back(0);
    if (with_pattern) out.row_offsets.push_back(0);
    std::size_t vertices = 0, triangles = 0, rest_areas = 0;
    for (const auto& topology : cloths) {
        apsl_cloth cloth{};
        cloth.vertex_begin = index(vertices, max_index, "vertices");
        cloth.vertex_count = index(topology->vertex_count(), max_index, "vertices");
        // Two bits of a corner hold its number.
        cloth.triangle_begin = index(triangles, max_index / 4, "triangles");
        cloth.triangle_count = index(topology->triangle_count(), max_index / 4, "triangles");
        cloth.rest_area_begin = index(rest_areas, max_index, "triangles");
        out.cloths.push_back(cloth);

        for (const Triangle& triangle : topology->triangles())
            for (const std::uint32_t vertex : triangle) out.triangles.push_back(cloth.vertex_begin + vertex);
        const std::size_t first_corner = out.corners.size();
        for (std::size_t v = 0; v < topology->vertex_count(); ++v)
            out.corner_offsets.push_back(static_cast<std::uint32_t>(first_corner + topology->corner_offsets()[v + 1]));
        for (const Corner corner : topology->corners())
            out.corners.push_back(4 * (cloth.triangle_begin + corner / 3) + corner % 3);
        if (with_pattern) append_pattern(out, *topology, matrix, cloth);

        vertices += topology->vertex_count();
        rest_areas += topology->triangle_count();
        triangles += topology->triangle_count();
        constexpr std::size_t alignment = APSL_TRIANGLE_ALIGNMENT;
        triangles = (triangles + alignment - 1) / alignment * alignment;
        out.triangles.resize(3 * triangles, 0);
        if (with_pattern) out.row_offsets.resize(triangles + 1, out.row_offsets.back());
    }
    out.vertex_count = index(vertices, max_index, "vertices");
    out.triangle_count = index(triangles, max_index / 4, "triangles");
    out.rest_area_count = index(rest_areas, max_index, "triangles");
    return out;
}

}  // namespace apsl::host
