// SPDX-License-Identifier: MIT
#include "methods/greedy_coloring.hpp"

#include <algorithm>
#include <limits>

namespace apsl::methods {

Coloring greedy_coloring(std::size_t constraint_count, std::size_t vertex_count,
                         const std::function<std::span<const std::uint32_t>(std::size_t)>& vertices_of) {
    constexpr std::size_t nobody = std::numeric_limits<std::size_t>::max();
    std::vector<std::vector<std::uint32_t>> colors_at(vertex_count);
    std::vector<std::size_t> last_barred_by;  // [colors], the last constraint that could not have this color
    std::vector<std::uint32_t> color_of(constraint_count);
    Coloring coloring;
    coloring.offsets.push_back(0);
    for (std::size_t constraint = 0; constraint < constraint_count; ++constraint) {
        const std::span<const std::uint32_t> vertices = vertices_of(constraint);
        for (const std::uint32_t v : vertices)
            for (const std::uint32_t color : colors_at[v]) last_barred_by[color] = constraint;
        const auto free = std::find_if(last_barred_by.begin(), last_barred_by.end(),
                                       [&](std::size_t barred_by) { return barred_by != constraint; });
        const auto color = static_cast<std::uint32_t>(free - last_barred_by.begin());
        if (free == last_barred_by.end()) {
            last_barred_by.push_back(nobody);
            coloring.offsets.push_back(0);
        }
        color_of[constraint] = color;
        ++coloring.offsets[color + 1];
        for (const std::uint32_t v : vertices) colors_at[v].push_back(color);
    }
    for (std::size_t c = 1; c < coloring.offsets.size(); ++c) coloring.offsets[c] += coloring.offsets[c - 1];
    std::vector<std::uint32_t> next(coloring.offsets.begin(), coloring.offsets.end() - 1);
    coloring.order.resize(constraint_count);
    for (std::size_t constraint = 0; constraint < constraint_count; ++constraint)
        coloring.order[next[color_of[constraint]]++] = static_cast<std::uint32_t>(constraint);
    return coloring;
}

}  // namespace apsl::methods
