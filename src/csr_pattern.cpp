// SPDX-License-Identifier: MIT
#include <apsl/error.hpp>
#include <apsl/topology.hpp>

#include <algorithm>
#include <limits>
#include <string>

namespace apsl {
namespace {

using CornerList = std::span<const Corner>;

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// The pattern's entry count where no triangle has a duplicate, a lower bound where one has: pairs of corners at one
/// vertex count a pair of triangles once for each vertex they share; those across an edge take one back.
std::uint64_t entry_count(std::span<const std::uint32_t> corner_offsets,
                          std::span<const std::uint32_t> edge_corner_offsets, std::size_t triangle_count,
                          Matrix matrix) {
    const auto sum_of_squares = [](std::span<const std::uint32_t> offsets) {
        std::uint64_t sum = 0;
        for (std::size_t b = 0; b + 1 < offsets.size(); ++b) {
            const std::uint64_t size = offsets[b + 1] - offsets[b];
            sum += size * size;
        }
        return sum;
    };
    const std::uint64_t across_edges = sum_of_squares(edge_corner_offsets);
    // Each triangle meets itself across three edges and is to be counted once.
    if (matrix == Matrix::printed) return across_edges - 2 * static_cast<std::uint64_t>(triangle_count);
    return sum_of_squares(corner_offsets) - across_edges + triangle_count;
}

std::vector<std::uint32_t> edge_of_corner(std::span<const std::uint32_t> edge_corner_offsets,
                                          std::span<const Corner> edge_corners) {
    std::vector<std::uint32_t> edge(edge_corners.size());
    for (std::uint32_t e = 0; e + 1 < edge_corner_offsets.size(); ++e)
        for (std::uint32_t position = edge_corner_offsets[e]; position < edge_corner_offsets[e + 1]; ++position)
            edge[edge_corners[position]] = e;
    return edge;
}

/// Appends one row: merges the three ascending lists of the corners met at corner 0, 1 and 2 of the row's triangle.
/// A triangle stands at most once in each list, because it names no vertex twice.
void append_row(const std::array<CornerList, 3>& met, CsrPattern& pattern) {
    std::array<std::size_t, 3> next{};
    const auto head = [&](std::size_t k) { return next[k] < met[k].size() ? met[k][next[k]] / 3 : none; };
    std::array<std::uint32_t, 3> triangle{head(0), head(1), head(2)};
    for (;;) {
        const std::uint32_t column = std::min({triangle[0], triangle[1], triangle[2]});
        if (column == none) return;
        std::uint32_t code = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t corner = 3;
            if (triangle[k] == column) {
                corner = met[k][next[k]] % 3;
                ++next[k];
                triangle[k] = head(k);
            }
            code |= corner << (2 * k);
        }
        pattern.columns.push_back(column);
        pattern.shared.push_back(static_cast<std::uint8_t>(code));
    }
}

}  // namespace

CsrPattern Topology::csr_pattern(Matrix matrix) const {
    constexpr std::uint64_t greatest_entry_count = std::numeric_limits<std::uint32_t>::max();
    const auto check = [&](std::uint64_t entries) {
        if (entries > greatest_entry_count)
            throw Error(ErrorCode::invalid_mesh,
                        "the matrix has at least " + std::to_string(entries) + " entries, expected at most " +
                            std::to_string(greatest_entry_count) + " (too many triangles meet at one vertex or edge)");
    };
    const std::uint64_t expected = entry_count(corner_offsets_, edge_corner_offsets_, triangles_.size(), matrix);
    check(expected);

    CsrPattern pattern;
    pattern.row_offsets.reserve(triangles_.size() + 1);
    pattern.columns.reserve(expected);
    pattern.shared.reserve(expected);
    pattern.row_offsets.push_back(0);

    // Both patterns are the same merge over different lists: corners at a vertex, or corners opposite an edge.
    const bool across_edges = matrix == Matrix::printed;
    const std::vector<std::uint32_t> bucket =
        across_edges ? edge_of_corner(edge_corner_offsets_, edge_corners_) : std::vector<std::uint32_t>{};
    const std::vector<std::uint32_t>& offsets = across_edges ? edge_corner_offsets_ : corner_offsets_;
    const std::vector<Corner>& corners = across_edges ? edge_corners_ : corners_;
    for (std::size_t a = 0; a < triangles_.size(); ++a) {
        std::array<CornerList, 3> met;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t b = across_edges ? bucket[3 * a + k] : triangles_[a][k];
            met[k] = CornerList(corners).subspan(offsets[b], offsets[b + 1] - offsets[b]);
        }
        append_row(met, pattern);
        check(pattern.columns.size());
        pattern.row_offsets.push_back(static_cast<std::uint32_t>(pattern.columns.size()));
    }
    return pattern;
}

}  // namespace apsl
