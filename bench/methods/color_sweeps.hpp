// SPDX-License-Identifier: MIT
#pragma once

#include "methods/greedy_coloring.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace apsl::methods {

/// Below this many constraints one thread is faster than a team that meets after every color.
inline constexpr std::size_t least_parallel_count = 1024;

/// Gauss–Seidel by colors (parallel within a color): relax(constraint) on all constraints, `iterations` times.
/// `constraints` must lie in color order.
template <class Constraint, class Relax>
void sweep_colors(std::vector<Constraint>& constraints, const Coloring& coloring, int iterations, const Relax& relax) {
#pragma omp parallel if (constraints.size() >= least_parallel_count)
    for (int iteration = 0; iteration < iterations; ++iteration)
        for (std::size_t color = 0; color < coloring.color_count(); ++color) {
            const std::size_t end = coloring.offsets[color + 1];
#pragma omp for schedule(static)
            for (std::size_t i = coloring.offsets[color]; i < end; ++i) relax(constraints[i]);
        }
}

}  // namespace apsl::methods
