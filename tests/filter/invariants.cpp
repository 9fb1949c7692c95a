// SPDX-License-Identifier: MIT
//
// What must hold of a call whatever the reference does: rest, rigid motion, pins, momentum, stopping, repetition.
#include "filter/filtered.hpp"
#include "support/tolerances.hpp"

#include <apsl/reference.hpp>

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;

namespace {

MovingCloth alternating(std::uint32_t side) {
    return moving_cloth(grid(side, side, 1.0, 1.0, Diagonals::alternating), 1);
}

/// Rounding of a position of 1 m as a velocity, m/s: what noise in the areas may come to.
double rounding_speed(const Parameters& parameters, double size) {
    return elementwise_tolerance(20) * size / static_cast<double>(parameters.time_step);
}

}  // namespace

TEST_CASE("a cloth at rest stays at rest", "[filter]") {
    for (const Options& options : variants) {
        MovingCloth cloth = alternating(17);
        cloth.velocities.assign(cloth.velocities.size(), 0.0);
        cloth.rest_areas = reference::areas<double>(*cloth.topology, cloth.positions);
        // The printed matrix amplifies noise from sub-step to sub-step where α < 2 (docs/formulation.md).
        const Parameters parameters{.sub_steps = options.matrix == Matrix::printed ? 1 : 10};
        const Filtered filtered = filter_on_device(cloth, options, parameters);
        CHECK(greatest(filtered.velocities) <= rounding_speed(parameters, 1.0));
        CHECK(filtered.stats.max_area_change <= 1e-5f);

        // And exactly, where the target is above rounding.
        const Filtered stopped = filter_on_device(cloth, options, {.target_area_change = 1e-4f});
        CHECK(stopped.velocities == cloth.velocities);
        CHECK(stopped.stats.sub_steps == 0);
        CHECK(stopped.stats.status == Status::ok);
    }
}

TEST_CASE("rigid motion is left alone", "[filter]") {
    for (const Options& options : variants) {
        MovingCloth cloth = alternating(17);
        cloth.inverse_masses.assign(cloth.inverse_masses.size(), 3.0);
        cloth.rest_areas = reference::areas<double>(*cloth.topology, cloth.positions);
        const Parameters parameters;
        const auto time_step = static_cast<double>(parameters.time_step);
        // A turn by 0.1 about (x, z) = (0.3, 0), and a shift, in one step.
        for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v) {
            const double x = cloth.positions[3 * v] - 0.3, z = cloth.positions[3 * v + 2];
            const double move[] = {std::cos(0.1) * x + std::sin(0.1) * z - x + 0.02, -0.05,
                                   -std::sin(0.1) * x + std::cos(0.1) * z - z};
            for (std::size_t k = 0; k < 3; ++k) cloth.velocities[3 * v + k] = static_cast<float>(move[k] / time_step);
        }
        const Filtered filtered = filter_on_device(cloth, options, parameters);
        double off = 0.0;
        for (std::size_t n = 0; n < cloth.velocities.size(); ++n)
            off = std::max(off, std::abs(filtered.velocities[n] - cloth.velocities[n]));
        CHECK(off <= rounding_speed(parameters, 1.0));
    }
}

TEST_CASE("a free cloth keeps its momentum", "[filter]") {
    for (const Options& options : variants) {
        MovingCloth cloth = alternating(17);
        for (double& inverse_mass : cloth.inverse_masses)
            if (inverse_mass == 0.0) inverse_mass = 250.0;
        const Filtered filtered = filter_on_device(cloth, options, Parameters{.regularization = 2.0f, .sub_steps = 4});
        double before[3] = {}, after[3] = {}, moved = 0.0, mass_speed = 0.0;
        for (std::size_t n = 0; n < cloth.velocities.size(); ++n) {
            const double mass = 1.0 / cloth.inverse_masses[n / 3];
            before[n % 3] += mass * cloth.velocities[n];
            after[n % 3] += mass * filtered.velocities[n];
            moved += mass * std::abs(filtered.velocities[n] - cloth.velocities[n]);
            mass_speed += mass * (60.0 + std::abs(cloth.velocities[n]));  // positions up to 1 m, rounded, a step
        }
        REQUIRE(moved > 0.0);
        for (int k = 0; k < 3; ++k)
            CHECK(std::abs(after[k] - before[k]) <= elementwise_tolerance(10) * (moved + mass_speed));
    }
}

TEST_CASE("pinned vertices keep every bit of their velocities", "[filter]") {
    for (const Options& options : variants) {
        MovingCloth cloth = alternating(9);
        const std::size_t pins[] = {0, 8, 40, 41};
        for (const std::size_t pin : pins) {
            cloth.inverse_masses[pin] = 0.0;
            cloth.velocities[3 * pin] = -0.0;
        }
        const Filtered filtered = filter_on_device(cloth, options, Parameters{.regularization = 2.0f, .sub_steps = 4});
        REQUIRE(filtered.velocities != cloth.velocities);
        for (const std::size_t pin : pins)
            for (std::size_t k = 0; k < 3; ++k) {
                CHECK(filtered.velocities[3 * pin + k] == cloth.velocities[3 * pin + k]);
                CHECK(std::signbit(filtered.velocities[3 * pin + k]) == std::signbit(cloth.velocities[3 * pin + k]));
            }
    }
}

TEST_CASE("the target area change ends a call early, and is then met", "[filter]") {
    const MovingCloth cloth = alternating(17);
    for (const Options& options : {variants[0], many_groups, one_group}) {
        Parameters parameters{.regularization = 1.2f, .sub_steps = 30, .stepping = Stepping::whole_step};
        const Filtered all = filter_on_device(cloth, options, parameters);
        parameters.target_area_change = 0.08f;
        const Filtered some = filter_on_device(cloth, options, parameters);
        parameters.target_area_change = 10.0f;
        const Filtered none = filter_on_device(cloth, options, parameters);
        parameters.target_area_change = 0.0f;
        CHECK(all.stats.sub_steps == 30);
        CHECK(some.stats.sub_steps > 0);
        CHECK(some.stats.sub_steps < 30);
        CHECK(some.stats.max_area_change <= 0.08f);
        // One sub-step fewer was not enough.
        parameters.sub_steps = some.stats.sub_steps - 1;
        const Filtered fewer = filter_on_device(cloth, options, parameters);
        CHECK(fewer.stats.max_area_change > 0.08f);
        CHECK(none.stats.sub_steps == 0);
        CHECK(none.velocities == cloth.velocities);
    }
}

TEST_CASE("no sub-steps: the areas are measured, nothing is moved", "[filter]") {
    const MovingCloth cloth = alternating(9);
    const Filtered filtered = filter_on_device(cloth, {}, {.sub_steps = 0});
    CHECK(filtered.velocities == cloth.velocities);
    CHECK(filtered.stats.status == Status::ok);
    CHECK(filtered.stats.iterations == 0);
    const double change = max_area_change(cloth, cloth.velocities, 1.0 / 60.0);
    CHECK(std::abs(static_cast<double>(filtered.stats.max_area_change) - change) <= 1e-5);
}

TEST_CASE("too few iterations are a status, and the best state reached stands", "[filter]") {
    const MovingCloth cloth = alternating(17);
    for (const Options& options : variants) {
        const Filtered filtered = filter_on_device(
            cloth, options, {.regularization = 2.0f, .sub_steps = 2, .tolerance = 1e-3f, .max_iterations = 1});
        CHECK(filtered.stats.status == Status::not_converged);
        CHECK(filtered.stats.sub_steps == 2);
        CHECK(filtered.stats.iterations == 2);
        CHECK(filtered.stats.residual > 1e-3f);
        CHECK(all_finite(filtered.velocities));
        CHECK(filtered.velocities != cloth.velocities);
    }
}

TEST_CASE("alpha of 1 and of a million both run", "[filter]") {
    const MovingCloth cloth = alternating(17);
    for (const Options& options : variants) {
        const Filtered undamped = filter_on_device(cloth, options, {.regularization = 1.0f, .sub_steps = 1});
        CHECK(undamped.stats.status != Status::diverged);
        CHECK(all_finite(undamped.velocities));
        const Parameters stiff{.regularization = 1e6f, .sub_steps = 2, .tolerance = 1e-4f};
        const Filtered damped = filter_on_device(cloth, options, stiff);
        CHECK(damped.stats.status == Status::ok);
        CHECK(damped.stats.iterations == 2);
        const Filtered expected = filter_with_reference(cloth, options, stiff);
        CHECK(difference(damped.velocities, expected.velocities) <= 1e-6 * norm(cloth.velocities) + 1e-4);
    }
}

TEST_CASE("a right-hand side the matrix cannot reach at alpha = 1 ends the solve, not the cloth", "[filter]") {
    // The same triangle twice with different rest areas: one up, one down is a null vector of G.
    Mesh mesh = right_triangle();
    mesh.triangles.push_back(mesh.triangles[0]);
    for (const Options& options : variants) {
        MovingCloth cloth = moving_cloth(mesh, 1);
        cloth.positions = mesh.positions;
        cloth.velocities.assign(9, 0.0);
        cloth.inverse_masses.assign(3, 1.0);
        cloth.rest_areas = {0.75, 1.25};
        const Filtered filtered =
            filter_on_device(cloth, options, {.regularization = 1.0f, .sub_steps = 3, .tolerance = 1e-3f});
        CHECK(filtered.stats.status == Status::not_converged);
        CHECK(greatest(filtered.velocities) <= 1e-3);
    }
}

TEST_CASE("two calls on the same input give the same bytes", "[filter]") {
    const MovingCloth cloth = moving_cloth(grid(65, 65, 1.0, 1.0, Diagonals::alternating), 1);
    for (Options options : variants)
        for (const std::uint32_t work_group_size : {0u, 64u}) {
            options.work_group_size = work_group_size;
            StrainLimiter limiter(device().context, device().id, cloth.topology, options);
            const Parameters parameters{.sub_steps = 4};
            const CallerBuffers first({&cloth, 1}, options), second({&cloth, 1}, options), third({&cloth, 1}, options);
            const std::vector<Stats> first_stats = filter(limiter, first, {&parameters, 1});
            const std::vector<Stats> second_stats = filter(limiter, second, {&parameters, 1});
            CHECK(same_bytes(first.read_velocities(), second.read_velocities()));
            CHECK(same_bytes(first_stats, second_stats));
            StrainLimiter another(device().context, device().id, cloth.topology, options);
            filter(another, third, {&parameters, 1});
            CHECK(same_bytes(first.read_velocities(), third.read_velocities()));
        }
}

TEST_CASE("two calls queued one after the other: the second works on what the first left", "[filter]") {
    const MovingCloth cloth = alternating(17);
    const Options options = GENERATE(many_groups, one_group);
    StrainLimiter limiter(device().context, device().id, cloth.topology, options);
    const Parameters parameters{.sub_steps = 3};
    const CallerBuffers waited({&cloth, 1}, options), queued({&cloth, 1}, options);
    filter(limiter, waited, {&parameters, 1});
    filter(limiter, waited, {&parameters, 1});
    const Owned<cl_command_queue> queue = in_order_queue();
    const cl_event first = limiter.enqueue(queue.get(), queued.views(), parameters);
    const cl_event second = limiter.enqueue(queue.get(), queued.views(), parameters);
    CHECK(wait_and_release(second) == CL_COMPLETE);
    CHECK(wait_and_release(first) == CL_COMPLETE);
    CHECK(same_bytes(waited.read_velocities(), queued.read_velocities()));
}
