// SPDX-License-Identifier: MIT
#include "amd/replay/scenarios.hpp"

#include "support/meshes.hpp"

#include <cstdint>
#include <limits>
#include <utility>

namespace apsl::test {
namespace {

// 512 triangles: work for every work-item of two groups of 256, of which each sums its own. A step of 15 % stretch, so
// that every sub-step has work.
MovingCloth two_groups() {
    return moving_cloth(grid(17, 17, 1.0, 1.0, Diagonals::alternating), 1);
}

// 96 triangles.
MovingCloth small() {
    return moving_cloth(grid(9, 7, 1.0, 0.7, Diagonals::random), 4);
}

std::vector<MovingCloth> unequal_cloths() {
    return {two_groups(), moving_cloth(right_triangle(), 2), moving_cloth(book(5), 3), small()};
}

// Not the library's defaults: few sub-steps, since every instruction of them is interpreted, and more iterations than
// are queued at once.
constexpr Parameters two_sub_steps{.regularization = 1.2f, .sub_steps = 2, .tolerance = 1e-5f, .max_iterations = 24};

constexpr Parameters small_steps(Parameters parameters) {
    parameters.stepping = Stepping::small_steps;
    return parameters;
}

constexpr Parameters falling(Parameters parameters) {
    parameters.acceleration = {0.5f, -9.81f, 0.25f};
    parameters.damping = 0.4f;
    parameters.sub_steps = 4;
    return small_steps(parameters);
}

constexpr Parameters with_ceiling(Parameters parameters) {
    parameters.stretch_ceiling = 1.05f;
    return parameters;
}

constexpr Parameters growing(Parameters parameters) {
    parameters = with_ceiling(parameters);
    parameters.most_sub_steps = 4;
    return small_steps(parameters);
}

constexpr Parameters bending(Parameters parameters) {
    parameters.bending = 1e-4f;
    return parameters;
}

constexpr Parameters adaptive(Parameters parameters) {
    parameters.adaptive_threshold = 1;
    parameters.first_regularization = 1.6f;
    return parameters;
}

constexpr Parameters off(Parameters parameters) {
    parameters.enabled = false;
    return parameters;
}

constexpr Parameters short_solve(Parameters parameters) {
    parameters.regularization = 2.0f;
    parameters.tolerance = 0.03f;
    parameters.max_iterations = 3;
    return parameters;
}

Options in_layout(Options options, std::uint32_t stride, std::uint32_t component_stride, std::uint32_t mass_stride) {
    return with_layout(options, {.position_stride = stride,
                                 .velocity_stride = stride,
                                 .position_component_stride = component_stride,
                                 .velocity_component_stride = component_stride,
                                 .inverse_mass_stride = mass_stride});
}
Options xyzw(const Options& options) {
    return in_layout(options, 4, 1, 4);
}
Options structure_of_arrays(const Options& options) {
    return in_layout(options, 1, 500, 1);
}
Options positions_only(Options options) {
    options.positions_only = true;
    return xyzw(options);
}

Options groups_of_64(Options options) {
    options.work_group_size = 64;
    return options;
}

constexpr Options by_gradient{.execution = Execution::many_groups};
constexpr Options by_chebyshev{.execution = Execution::many_groups, .solver = Solver::chebyshev};
constexpr Options csr{.apply = Apply::assembled_csr, .execution = Execution::many_groups};
constexpr Options printed{.matrix = Matrix::printed, .execution = Execution::many_groups};
constexpr Options printed_csr{
    .matrix = Matrix::printed, .apply = Apply::assembled_csr, .execution = Execution::many_groups};
constexpr Options alpha_each{.execution = Execution::many_groups, .regularization_per_triangle = true};
constexpr Options warm{.execution = Execution::many_groups, .warm_start_sub_steps = 2};
constexpr Options warm_step_alpha_each{.execution = Execution::many_groups,
                                       .regularization_per_triangle = true,
                                       .warm_start_sub_steps = 2,
                                       .integrates = true};
constexpr Options stretch{.execution = Execution::many_groups, .limits_stretch = true};
constexpr Options stretch_each{
    .execution = Execution::many_groups, .limits_stretch = true, .stretch_ceiling_per_triangle = true};
constexpr Options step{.execution = Execution::many_groups, .integrates = true};
constexpr Options step_with_ceiling{.execution = Execution::many_groups, .limits_stretch = true, .integrates = true};
constexpr Options contact{.execution = Execution::many_groups, .keeps_contacts = true};
constexpr Options step_contact_ceiling{
    .execution = Execution::many_groups, .limits_stretch = true, .integrates = true, .keeps_contacts = true};
constexpr Options step_bending{
    .execution = Execution::many_groups, .limits_stretch = true, .integrates = true, .bends = true};
constexpr Options step_accelerations{
    .execution = Execution::many_groups, .integrates = true, .acceleration_per_vertex = true};
constexpr Options step_with_all{.execution = Execution::many_groups,
                                .limits_stretch = true,
                                .integrates = true,
                                .keeps_contacts = true,
                                .bends = true,
                                .acceleration_per_vertex = true};
constexpr Options step_tethers{.execution = Execution::many_groups,
                               .limits_stretch = true,
                               .integrates = true,
                               .tethers_per_vertex = MovingCloth::tethers};
constexpr Options one_group{.execution = Execution::one_group};

Scenario one_cloth(std::string name, const Options& options, const Parameters& parameters, int calls = 1) {
    return {std::move(name), options, {parameters}, {two_groups()}, calls};
}

Scenario of(std::string name, const Options& options, const Parameters& parameters, MovingCloth cloth) {
    return {std::move(name), options, {parameters}, {std::move(cloth)}};
}

MovingCloth with_coordinate(MovingCloth cloth, double value) {
    cloth.positions[15] = value;
    return cloth;
}

MovingCloth scaled(MovingCloth cloth, double factor) {
    for (std::vector<double>* numbers : {&cloth.positions, &cloth.velocities})
        for (double& number : *numbers) number = static_cast<float>(number * factor);
    for (double& area : cloth.rest_areas) area = static_cast<float>(area * factor * factor);
    for (double& entry : cloth.rest_shapes) entry = static_cast<float>(entry / factor);
    return cloth;
}

// Every seventh vertex lies on its neighbour, and a third of them is pinned: triangles without area or gradient.
MovingCloth collapsed(MovingCloth cloth) {
    for (std::size_t v = 3; v < cloth.inverse_masses.size(); v += 7)
        for (std::size_t k = 0; k < 3; ++k) {
            cloth.positions[3 * v + k] = cloth.positions[3 * (v - 1) + k];
            cloth.velocities[3 * v + k] = cloth.velocities[3 * (v - 1) + k];
        }
    for (std::size_t v = 2 * cloth.inverse_masses.size() / 3; v < cloth.inverse_masses.size(); ++v)
        cloth.inverse_masses[v] = 0.0;
    return cloth;
}

}  // namespace

std::vector<Scenario> small_scenarios() {
    constexpr Parameters p = two_sub_steps;
    return {
        one_cloth("gradient", by_gradient, p),
        one_cloth("gradient_arrays_64", groups_of_64(structure_of_arrays(by_gradient)), small_steps(p)),
        one_cloth("gradient_positions", positions_only(by_gradient), p),
        {"warm_start_cloths", xyzw(warm), {p, small_steps(p), off(p), adaptive(p)}, unequal_cloths(), 2},
        one_cloth("csr", csr, short_solve(p)),
        one_cloth("printed_64", groups_of_64(printed), short_solve(p)),
        one_cloth("printed", printed, short_solve(p)),
        one_cloth("printed_csr_64", groups_of_64(printed_csr), short_solve(p)),
        one_cloth("chebyshev", by_chebyshev, p),
        one_cloth("stretch", stretch, growing(p), 2),
        one_cloth("stretch_positions", positions_only(stretch), with_ceiling(p)),
        {"stretch_cloths_64", groups_of_64(stretch_each), {with_ceiling(p), p, off(p), growing(p)}, unequal_cloths()},
        one_cloth("step_arrays_64", groups_of_64(structure_of_arrays(warm_step_alpha_each)), falling(p), 2),
        one_cloth("step_stretch", step_with_ceiling, falling(growing(p))),
        one_cloth("step_stretch_xyzw_64", groups_of_64(xyzw(step_with_ceiling)), falling(growing(p))),
        one_cloth("contact", contact, small_steps(p)),
        one_cloth("step_contact_ceiling_64", groups_of_64(step_contact_ceiling), falling(growing(p))),
        one_cloth("step_bending", step_bending, bending(falling(with_ceiling(p)))),
        of("step_bending_64", groups_of_64(step_bending), bending(falling(with_ceiling(p))), small()),
        one_cloth("step_accelerations_arrays", structure_of_arrays(step_accelerations), falling(p)),
        of("step_with_all_64", groups_of_64(step_with_all), bending(falling(growing(p))), small()),
        one_cloth("step_tethers_arrays", structure_of_arrays(step_tethers), falling(growing(p))),
        of("step_tethers_64", groups_of_64(step_tethers), falling(growing(p)), small()),
        one_cloth("one_group", one_group, short_solve(p)),
        of("one_group_xyzw_64", groups_of_64(xyzw(one_group)), small_steps(short_solve(p)), small()),
        of("one_group_arrays_64", groups_of_64(structure_of_arrays(one_group)), short_solve(p), small()),
        of("one_group_positions_64", groups_of_64(positions_only(one_group)), short_solve(p), small()),
    };
}

std::vector<Scenario> further_scenarios() {
    constexpr Parameters p = two_sub_steps;
    constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
    const MovingCloth full = moving_cloth(grid(65, 65, 1.0, 1.0, Diagonals::alternating), 1);
    return {
        one_cloth("chebyshev_positions_64", groups_of_64(positions_only(by_chebyshev)), p),
        one_cloth("gradient_xyzw", xyzw(by_gradient), small_steps(p)),
        one_cloth("gradient_64", groups_of_64(by_gradient), p),
        {"cloths_64", groups_of_64(by_gradient), {p, small_steps(p), off(p), adaptive(p)}, unequal_cloths()},
        one_cloth("alpha_each", alpha_each, adaptive(p)),
        one_cloth("csr_64", groups_of_64(csr), p),
        one_cloth("printed_csr", printed_csr, short_solve(p)),
        one_cloth("warm_start_64", groups_of_64(warm), small_steps(p), 2),
        one_cloth("chebyshev_64", groups_of_64(by_chebyshev), small_steps(p)),
        one_cloth("stretch_each", stretch_each, growing(p)),
        one_cloth("step_xyzw_64", groups_of_64(xyzw(step)), falling(p)),
        one_cloth("step_stretch_arrays", structure_of_arrays(step_with_ceiling), falling(growing(p))),
        one_cloth("one_group_64", groups_of_64(one_group), small_steps(short_solve(p))),
        of("full_gradient", by_gradient, p, full),
        of("full_stretch", stretch, growing(p), full),
        of("full_one_group", one_group, short_solve(p), moving_cloth(grid(33, 33, 1.0, 1.0, Diagonals::random), 2)),
        of("not_a_number", by_gradient, p, with_coordinate(two_groups(), not_a_number)),
        of("not_a_number_stretch", stretch, growing(p), with_coordinate(two_groups(), not_a_number)),
        of("not_a_number_one_group", one_group, p, with_coordinate(two_groups(), not_a_number)),
        of("overflow", by_gradient, p, with_coordinate(two_groups(), 1e30)),
        of("overflow_stretch", stretch, growing(p), with_coordinate(two_groups(), 1e30)),
        of("overflow_one_group", one_group, p, with_coordinate(two_groups(), 1e30)),
        of("tiny", by_gradient, p, scaled(two_groups(), 1e-10)),
        of("tiny_stretch", stretch, growing(p), scaled(two_groups(), 1e-10)),
        of("huge", by_gradient, p, scaled(two_groups(), 1e9)),
        of("huge_stretch", stretch, growing(p), scaled(two_groups(), 1e9)),
        of("collapsed", by_gradient, p, collapsed(two_groups())),
        of("collapsed_stretch", stretch, growing(p), collapsed(two_groups())),
        of("collapsed_one_group", one_group, p, collapsed(two_groups())),
    };
}

}  // namespace apsl::test
