// SPDX-License-Identifier: MIT
#include "filter/filtered.hpp"

#include "resolved_parameters.hpp"
#include "support/thorough.hpp"
#include "support/tolerances.hpp"

#include <apsl/reference.hpp>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

namespace apsl::test {

std::string variant_name(const Options& options) {
    const std::string size =
        options.work_group_size == 0 ? "the default size" : std::to_string(options.work_group_size);
    return std::string(resolved_solver(options) == Solver::chebyshev ? "chebyshev"
                       : options.matrix == Matrix::consistent        ? "consistent"
                                                                     : "printed") +
           (options.apply == Apply::assembled_csr ? ", assembled" : ", matrix-free") +
           (options.execution == Execution::one_group     ? ", one group of "
            : options.execution == Execution::many_groups ? ", many groups of "
                                                          : ", groups of ") +
           size;
}

std::vector<std::uint32_t> compared_group_sizes() {
    if (thorough()) return {1, 64};
    return {64};
}

std::vector<MovingCloth> small_cloths() {
    return {moving_cloth(grid(17, 13, 1.0, 0.7, Diagonals::uniform), 1),
            moving_cloth(grid(33, 33, 1.0, 1.0, Diagonals::alternating), 2),
            moving_cloth(grid(21, 9, 2.0, 1.0, Diagonals::random), 3),
            moving_cloth(tetrahedron(), 4),
            moving_cloth(book(5), 5),
            moving_cloth(fan(9), 6),
            moving_cloth(right_triangle(), 7)};
}

MovingCloth flat_sheet(std::uint32_t n, const std::vector<std::uint32_t>& pins) {
    const Mesh mesh = grid(n, n, 1.0, 1.0, Diagonals::alternating);
    MovingCloth cloth = moving_cloth(mesh, 1);
    cloth.positions = mesh.positions;
    for (double& x : cloth.positions) x = static_cast<float>(x);
    cloth.inverse_masses = reference::inverse_masses<double>(*cloth.topology, cloth.rest_areas, 0.2);
    for (const std::uint32_t pin : pins) cloth.inverse_masses[pin] = 0.0;
    for (double& w : cloth.inverse_masses) w = static_cast<float>(w);
    std::fill(cloth.velocities.begin(), cloth.velocities.end(), 0.0);
    return cloth;
}

std::vector<std::shared_ptr<const Topology>> topologies_of(const std::vector<MovingCloth>& cloths) {
    std::vector<std::shared_ptr<const Topology>> topologies;
    for (const MovingCloth& cloth : cloths) topologies.push_back(cloth.topology);
    return topologies;
}

Filtered filter_on_device(const MovingCloth& cloth, const Options& options, const Parameters& parameters,
                          std::size_t offset) {
    StrainLimiter limiter(device().context, device().id, cloth.topology, options);
    const CallerBuffers buffers({&cloth, 1}, options, offset);
    const std::vector<Stats> stats = filter(limiter, buffers, {&parameters, 1});
    const std::vector<float> velocities = buffers.read_velocities();
    return {{velocities.begin(), velocities.end()}, stats[0]};
}

Filtered filter_with_reference(const MovingCloth& cloth, const Options& options, const Parameters& parameters) {
    Options from_zero = options;
    from_zero.warm_start_sub_steps = 0;
    reference::StrainLimiter limiter(cloth.topology, from_zero);
    std::vector<double> velocities = cloth.velocities;
    std::span<const double> alpha;
    if (options.regularization_per_triangle) alpha = cloth.regularization;
    std::span<const double> shapes, ceilings, contacts;
    if (options.limits_stretch) shapes = cloth.rest_shapes;
    if (options.stretch_ceiling_per_triangle) ceilings = cloth.stretch_ceilings;
    if (options.keeps_contacts) contacts = cloth.contacts;
    limiter.enqueue(
        {cloth.positions, velocities, cloth.inverse_masses, cloth.rest_areas, alpha, shapes, ceilings, contacts},
        parameters);
    return {velocities, limiter.read_stats()};
}

double max_area_change(const MovingCloth& cloth, const std::vector<double>& velocities, double time_step) {
    std::vector<double> end = cloth.positions;
    for (std::size_t n = 0; n < end.size(); ++n) end[n] += time_step * velocities[n];
    const std::vector<double> areas = reference::areas<double>(*cloth.topology, end);
    double change = 0.0;
    for (std::size_t a = 0; a < areas.size(); ++a)
        if (cloth.rest_areas[a] > 0.0)
            change = std::max(change, std::abs(areas[a] - cloth.rest_areas[a]) / cloth.rest_areas[a]);
    return change;
}

bool all_finite(const std::vector<double>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); });
}

double greatest(const std::vector<double>& numbers) {
    double result = 0.0;
    for (const double number : numbers) result = std::max(result, std::abs(number));
    return result;
}

void check_against_reference(const MovingCloth& cloth, const Options& options, const Parameters& parameters,
                             std::size_t offset) {
    check_against_reference(filter_on_device(cloth, options, parameters, offset), cloth, options, parameters);
}

void check_against_reference(const Filtered& got, const MovingCloth& cloth, const Options& options,
                             const Parameters& parameters) {
    const Filtered want = filter_with_reference(cloth, options, parameters);
    const auto time_step = static_cast<double>(parameters.time_step);
    const auto tolerance = static_cast<double>(ResolvedParameters(parameters, options).solve_tolerance);

    std::vector<double> correction(want.velocities.size());
    for (std::size_t n = 0; n < correction.size(); ++n) correction[n] = want.velocities[n] - cloth.velocities[n];
    // Two solves that meet the tolerance may stop an iteration apart: each then is off by the condition number times
    // the tolerance, about 20 at α = 1.2, and more where α is nearer to 1. Beyond that 32 bits round positions at their
    // own size, in every sub-step, and divide by the time step.
    // The stored gradients put the matrix itself off in the same way.
    const double solves = 2.0 * 20.0 * (tolerance + stored_product_tolerance) * norm(correction);
    const double rounding = elementwise_tolerance(20.0 * (parameters.sub_steps + 1)) *
                            (norm(cloth.positions) / time_step + norm(cloth.velocities));
    CHECK(difference(got.velocities, want.velocities) <= solves + rounding);
    CHECK(got.stats.status == want.stats.status);
    CHECK(got.stats.sub_steps == want.stats.sub_steps);
    CHECK(std::abs(got.stats.iterations - want.stats.iterations) <= want.stats.sub_steps);
    CHECK((got.stats.status != Status::ok ||
           got.stats.residual <= ResolvedParameters(parameters, options).solve_tolerance));

    // What the device says of the areas, against the areas its velocities lead to. Positions round at their own size:
    // relative to a triangle's height that is the relative error of its area.
    const double smallest = *std::min_element(cloth.rest_areas.begin(), cloth.rest_areas.end());
    const double area_error = elementwise_tolerance(10) * (1.0 + greatest(cloth.positions) / std::sqrt(smallest));
    CHECK(std::abs(static_cast<double>(got.stats.max_area_change) -
                   max_area_change(cloth, got.velocities, time_step)) <= 4.0 * area_error);
    CHECK(got.stats.rms_area_change <= got.stats.max_area_change);
}

}  // namespace apsl::test
