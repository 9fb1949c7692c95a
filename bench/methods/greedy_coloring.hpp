// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace apsl::methods {

/// Constraints in groups, no two of a group sharing a vertex: those of a group can move their vertices at once.
struct Coloring {
    /// [colors + 1]; color c holds order[offsets[c]] up to order[offsets[c + 1]].
    std::vector<std::uint32_t> offsets;
    std::vector<std::uint32_t> order;  ///< [constraints], constraint numbers, ascending within a color

    std::size_t color_count() const { return offsets.size() - 1; }
};

/// Each constraint, in the order given, takes the least color that no earlier constraint at its vertices has.
/// `vertices_of(constraint)`: its vertices, each < vertex_count. No constraints: no colors.
Coloring greedy_coloring(std::size_t constraint_count, std::size_t vertex_count,
                         const std::function<std::span<const std::uint32_t>(std::size_t)>& vertices_of);

/// Colors `constraints` by greedy_coloring and puts them in color order. `vertices_of(constraint)`, or a member: its
/// vertices.
template <class Constraint, class Vertices>
Coloring sort_by_color(std::vector<Constraint>& constraints, std::size_t vertex_count, const Vertices& vertices_of) {
    Coloring coloring = greedy_coloring(constraints.size(), vertex_count, [&](std::size_t i) {
        return std::span<const std::uint32_t>(std::invoke(vertices_of, constraints[i]));
    });
    std::vector<Constraint> ordered;
    ordered.reserve(constraints.size());
    for (const std::uint32_t i : coloring.order) ordered.push_back(constraints[i]);
    constraints = std::move(ordered);
    return coloring;
}

}  // namespace apsl::methods
