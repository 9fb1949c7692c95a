// SPDX-License-Identifier: MIT
#include "stability/fuzz/call_facts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace apsl::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool finite(const std::vector<double>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); });
}

double largest(const std::vector<double>& numbers) {
    double result = 0.0;
    for (const double number : numbers) result = std::max(result, std::abs(number));
    return result;
}

bool must_diverge_on(const MovingCloth& cloth) {
    const auto any = [](const std::vector<double>& numbers, double least) {
        return std::any_of(numbers.begin(), numbers.end(),
                           [&](double number) { return !std::isfinite(number) || number < least; });
    };
    return any(cloth.positions, -infinity) || any(cloth.velocities, -infinity) || any(cloth.inverse_masses, 0.0) ||
           any(cloth.rest_areas, 0.0);
}

std::vector<double> end_of_step(const MovingCloth& cloth, const std::vector<double>& velocities, double time_step) {
    std::vector<double> end = cloth.positions;
    for (std::size_t n = 0; n < end.size(); ++n) end[n] += time_step * velocities[n];
    return end;
}

std::array<double, 3> edge_lengths(const Triangle& triangle, const std::vector<double>& x) {
    std::array<double, 3> lengths{};
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = 3 * triangle[(k + 1) % 3], j = 3 * triangle[(k + 2) % 3];
        lengths[k] = std::hypot(x[j] - x[i], x[j + 1] - x[i + 1], x[j + 2] - x[i + 2]);
    }
    return lengths;
}

bool ordinary(const std::vector<double>& numbers, double least, double greatest) {
    return std::all_of(numbers.begin(), numbers.end(), [&](double number) {
        return number == 0.0 || (std::abs(number) >= least && std::abs(number) <= greatest);
    });
}

}  // namespace

CallFacts::CallFacts(const MovingCloth& cloth, const Options& options, const Parameters& parameters,
                     const Filtered& filtered, double epsilon) {
    input_is_finite =
        finite(cloth.positions) && finite(cloth.velocities) && finite(cloth.inverse_masses) && finite(cloth.rest_areas);
    must_diverge = must_diverge_on(cloth);
    smallest_alpha = static_cast<double>(parameters.regularization);
    if (options.regularization_per_triangle)
        smallest_alpha = *std::min_element(cloth.regularization.begin(), cloth.regularization.end());
    if (parameters.first_regularization > 0.0f) {
        const double damping = (static_cast<double>(parameters.first_regularization) - 1.0) /
                               (static_cast<double>(parameters.regularization) - 1.0);
        smallest_alpha = std::min(smallest_alpha, 1.0 + damping * (smallest_alpha - 1.0));
    }

    const auto time_step = static_cast<double>(parameters.time_step);
    const std::vector<double> x = end_of_step(cloth, cloth.velocities, time_step);
    end = options.integrates ? filtered.positions : end_of_step(cloth, filtered.velocities, time_step);
    greatest_position = std::max({largest(cloth.positions), largest(x), largest(end),
                                  time_step * largest(cloth.velocities), time_step * largest(filtered.velocities)});
    position_error = 2.0 * epsilon * (filtered.stats.sub_steps + 3) * greatest_position;

    const std::vector<double> areas_before = reference::areas<double>(*cloth.topology, x);
    const std::vector<double> areas_after = reference::areas<double>(*cloth.topology, end);
    const std::size_t count = cloth.rest_areas.size();
    before.assign(count, 0.0);
    after.assign(count, 0.0);
    change_error.assign(count, 0.0);
    double squares = 0.0, longest = 0.0;
    for (std::size_t a = 0; a < count; ++a) {
        const double rest_area = cloth.rest_areas[a];
        if (!(rest_area > 0.0)) continue;
        before[a] = std::abs(areas_before[a] - rest_area) / rest_area;
        after[a] = std::abs(areas_after[a] - rest_area) / rest_area;
        const Triangle& triangle = cloth.topology->triangles()[a];
        const std::array<double, 3> edges = edge_lengths(triangle, x), edges_after = edge_lengths(triangle, end);
        const double edge = std::max(*std::max_element(edges.begin(), edges.end()),
                                     *std::max_element(edges_after.begin(), edges_after.end()));
        longest = std::max(longest, edge);
        // An edge is off by two coordinates' error in each direction, 4 δ; the product of two edges by their rounding.
        const double area_error = 8.0 * position_error * (edge + position_error) + 8.0 * epsilon * edge * edge;
        change_error[a] = area_error / rest_area + 8.0 * epsilon * (1.0 + after[a]) + 1e-6 * after[a];

        double least_diagonal = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double length = std::max(0.0, edges[k] - 4.0 * position_error);
            least_diagonal += 0.5 * cloth.inverse_masses[triangle[k]] * length * length;
        }
        const bool can_move = std::any_of(triangle.begin(), triangle.end(),
                                          [&](std::uint32_t v) { return cloth.inverse_masses[v] > 0.0; });
        if (!can_move) continue;
        const double excess = std::abs(areas_before[a] - rest_area) + area_error;
        squares += least_diagonal > 0.0 ? excess * excess / least_diagonal : infinity;
    }
    scaled_excess = std::sqrt(squares);
    max_before = largest(before);
    max_after = largest(after);
    max_change_error = largest(change_error);
    rms_before = rms(before, cloth.rest_areas);
    rms_after = rms(after, cloth.rest_areas);
    const auto capped = [](std::vector<double> changes) {
        for (double& change : changes) change = std::clamp(change, -1.0, 1.0);
        return changes;
    };
    capped_rms_before = rms(capped(before), cloth.rest_areas);
    capped_rms_after = rms(capped(after), cloth.rest_areas);

    // Fourth powers of lengths, masses in between and out again: 1e-6 to 1e6 stays far from the ends of the range.
    ordinary_numbers = input_is_finite && greatest_position < 1e6 && longest < 1e6 &&
                       ordinary(cloth.rest_areas, 1e-12, 1e6) && ordinary(cloth.inverse_masses, 1e-6, 1e12) &&
                       max_before < 1e9 && ordinary(cloth.positions, 1e-12, 1e6);
    greatest_inverse_mass = largest(cloth.inverse_masses);
    greatest_valence = 0.0;
    const std::span<const std::uint32_t> offsets = cloth.topology->corner_offsets();
    for (std::size_t v = 0; v + 1 < offsets.size(); ++v)
        greatest_valence = std::max(greatest_valence, static_cast<double>(offsets[v + 1] - offsets[v]));
}

double CallFacts::rms(const std::vector<double>& changes, const std::vector<double>& rest_areas) {
    double squares = 0.0, weights = 0.0;
    for (std::size_t a = 0; a < changes.size(); ++a) {
        if (!(rest_areas[a] > 0.0)) continue;
        squares += rest_areas[a] * changes[a] * changes[a];
        weights += rest_areas[a];
    }
    return weights > 0.0 ? std::sqrt(squares / weights) : 0.0;
}

}  // namespace apsl::test
