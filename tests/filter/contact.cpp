// SPDX-License-Identifier: MIT
#include "filter/stepped.hpp"
#include "support/tolerances.hpp"

#include <apsl/error.hpp>
#include <apsl/reference.hpp>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace apsl;
using namespace apsl::test;

namespace {

constexpr Options filtering{.keeps_contacts = true};
constexpr Options with_ceiling{.limits_stretch = true, .keeps_contacts = true};
constexpr Options stepping{.integrates = true, .keeps_contacts = true};

constexpr Parameters tight(int sub_steps, float stretch_ceiling = 0.0f) {
    return {.regularization = 1.2f, .sub_steps = sub_steps, .tolerance = 3e-4f, .stretch_ceiling = stretch_ceiling};
}

// How deep x lies under its vertex' plane at the end of the step, m.
double greatest_depth(const MovingCloth& cloth, const std::vector<double>& x) {
    double greatest = 0.0;
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
        if (cloth.inverse_masses[v] == 0.0) continue;
        const double* n = cloth.contacts.data() + 8 * v;
        if (n[0] != 0.0 || n[1] != 0.0 || n[2] != 0.0)
            greatest = std::max(greatest, n[3] - n[0] * x[3 * v] - n[1] * x[3 * v + 1] - n[2] * x[3 * v + 2]);
    }
    return greatest;
}

std::vector<double> led_to(const MovingCloth& cloth, const std::vector<double>& velocities,
                           const Parameters& parameters) {
    std::vector<double> end = cloth.positions;
    for (std::size_t n = 0; n < end.size(); ++n) end[n] += static_cast<double>(parameters.time_step) * velocities[n];
    return end;
}

// A sheet of 1 m above a ball of 0.3 m around the origin.
MovingCloth sheet_over_ball(std::uint32_t side) {
    MovingCloth cloth = moving_cloth(grid(side, side, 1.0, 1.0, Diagonals::alternating), 1);
    const Mesh mesh = grid(side, side, 1.0, 1.0, Diagonals::alternating);
    cloth.positions = mesh.positions;
    for (std::size_t n = 1; n < cloth.positions.size(); n += 3) cloth.positions[n] = 0.32;
    std::fill(cloth.velocities.begin(), cloth.velocities.end(), 0.0);
    cloth.inverse_masses = reference::inverse_masses<double>(*cloth.topology, cloth.rest_areas, 0.2);
    return cloth;
}

constexpr double ball_radius = 0.3;

// The ball's tangent plane next to where each vertex is.
void find_contacts(MovingCloth& cloth, double friction) {
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
        const double* x = cloth.positions.data() + 3 * v;
        const double distance = std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
        double* contact = cloth.contacts.data() + 8 * v;
        for (std::size_t k = 0; k < 3; ++k) contact[k] = x[k] / distance;
        contact[3] = ball_radius;
        contact[4] = contact[5] = contact[6] = 0.0;
        contact[7] = friction;
    }
}

// A step over the ball, with the status and the contact that it must keep. Leaves the cloth at its end.
Ended step_over_ball(StrainLimiter& limiter, MovingCloth& cloth, const Options& options, const Parameters& parameters) {
    find_contacts(cloth, 0.3);
    const Ended end = step_on_device(limiter, cloth, options, parameters);
    REQUIRE(end.stats.status == Status::ok);
    CHECK(greatest_depth(cloth, end.positions) < 1e-6);
    cloth.positions = end.positions;
    cloth.velocities = end.velocities;
    return end;
}

// J.
double kinetic_energy_of(const MovingCloth& cloth) {
    double energy = 0.0;
    for (std::size_t n = 0; n < cloth.velocities.size(); ++n)
        energy += 0.5 * cloth.velocities[n] * cloth.velocities[n] / cloth.inverse_masses[n / 3];
    return energy;
}

// Kinetic and of height, J.
double energy_of(const MovingCloth& cloth) {
    double energy = kinetic_energy_of(cloth);
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v)
        energy += 9.81 * cloth.positions[3 * v + 1] / cloth.inverse_masses[v];
    return energy;
}

}  // namespace

TEST_CASE("contact: the device agrees with the reference", "[filter][contact]") {
    for (const MovingCloth& cloth : small_cloths())
        for (const auto& [options, parameters] :
             {std::pair{filtering, tight(3)}, {filtering, tight(24)}, {with_ceiling, tight(6, 1.05f)}})
            for (const std::uint32_t work_group_size : compared_group_sizes()) {
                Options sized = options;
                sized.work_group_size = work_group_size;
                CAPTURE(cloth.rest_areas.size(), parameters.sub_steps, options.limits_stretch, work_group_size);
                check_against_reference(cloth, sized, parameters, 5);
            }
}

TEST_CASE("contact: a whole step on the device agrees with the reference", "[filter][contact][whole_step]") {
    for (const MovingCloth& cloth : small_cloths()) {
        Parameters parameters = tight(24);
        parameters.acceleration = {0.5f, -9.81f, 0.25f};
        CAPTURE(cloth.rest_areas.size());
        check_step_against_reference(cloth, stepping, parameters);
    }
}

TEST_CASE("contact: every vertex ends outside of what it touches, limited or not", "[filter][contact]") {
    std::size_t inside = 0;
    for (const MovingCloth& cloth : small_cloths())
        for (const float target : {0.0f, 1e6f}) {
            Parameters parameters = tight(12);
            parameters.target_area_change = target;
            inside += greatest_depth(cloth, led_to(cloth, cloth.velocities, parameters)) > 1e-3;
            const Filtered filtered = filter_on_device(cloth, filtering, parameters);
            CAPTURE(cloth.rest_areas.size(), target);
            CHECK(filtered.stats.status != Status::diverged);
            const double rounding = elementwise_tolerance(40.0) * (greatest(cloth.positions) + 1.0);
            CHECK(greatest_depth(cloth, led_to(cloth, filtered.velocities, parameters)) <= rounding);
            CHECK(greatest_depth(cloth, step_on_device(cloth, stepping, parameters).positions) <= rounding);
        }
    CHECK(inside > small_cloths().size());
}

TEST_CASE("contact: what is not finite ends the call", "[filter][contact]") {
    MovingCloth cloth = small_cloths()[0];
    std::size_t free_vertex = 0;
    while (cloth.inverse_masses[free_vertex] == 0.0 || cloth.contacts[8 * free_vertex + 1] == 0.0) ++free_vertex;
    for (const std::size_t number : {0u, 3u, 4u}) {
        MovingCloth broken = cloth;
        broken.contacts[8 * free_vertex + number] = std::numeric_limits<double>::quiet_NaN();
        const Filtered filtered = filter_on_device(broken, filtering, tight(12));
        CAPTURE(number);
        CHECK(filtered.stats.status == Status::diverged);
        CHECK(filtered.velocities == cloth.velocities);
    }
}

TEST_CASE("contact: a sheet falls on a ball, and areas, ceiling and contact hold at once, frame by frame",
          "[filter][contact][whole_step]") {
    MovingCloth cloth = sheet_over_ball(33);
    constexpr Options options{.limits_stretch = true, .integrates = true, .keeps_contacts = true};
    StrainLimiter limiter(device().context, device().id, cloth.topology, options);
    const Parameters parameters{.stretch_ceiling = 1.1f, .acceleration = {0.0f, -9.81f, 0.0f}, .damping = 1.0f};
    double least_energy = std::numeric_limits<double>::infinity();
    double in_motion = 0.0, at_rest = 0.0, stretch = 0.0;  // greatest, of areas their change
    for (int frame = 0; frame < 90; ++frame) {
        CAPTURE(frame);
        const Ended end = step_over_ball(limiter, cloth, options, parameters);
        const double energy = energy_of(cloth);
        CHECK(energy < least_energy + 1e-4);
        least_energy = std::min(least_energy, energy);
        double& area_change = frame < 45 ? in_motion : at_rest;
        area_change = std::max(area_change, static_cast<double>(end.stats.max_area_change));
        stretch = std::max(stretch, static_cast<double>(end.stats.max_stretch));
    }
    CHECK(in_motion < 0.1);
    CHECK(at_rest < 0.005);
    CHECK(stretch < 1.14);
    // It hangs on the ball: what was above its middle still is, and the hem is below it.
    CHECK(cloth.positions[3 * (16 * 33 + 16) + 1] > ball_radius - 1e-6);
    CHECK(cloth.positions[1] < 0.0);
}

TEST_CASE("contact and bending: the device agrees with the reference", "[filter][contact][bending][whole_step]") {
    constexpr Options options{.limits_stretch = true, .integrates = true, .keeps_contacts = true, .bends = true};
    for (const MovingCloth& cloth : small_cloths())
        for (const auto& [sub_steps, rigidity] : {std::pair{3, 1e-3f}, {6, 0.02f}, {6, 50.0f}})
            for (const std::uint32_t work_group_size : compared_group_sizes()) {
                Parameters parameters = tight(sub_steps, 1.05f);
                parameters.acceleration = {0.5f, -9.81f, 0.25f};
                parameters.damping = 0.4f;
                parameters.bending = rigidity;
                Options sized = options;
                sized.work_group_size = work_group_size;
                CAPTURE(cloth.rest_areas.size(), sub_steps, rigidity, work_group_size);
                const auto& [got, want] = check_step_against_reference(cloth, sized, parameters);
                CHECK(greatest_depth(cloth, got.positions) <=
                      elementwise_tolerance(40.0) * (greatest(cloth.positions) + 1.0));
            }
}

TEST_CASE("contact and bending: the stiffer a sheet, the higher its corners come to rest on a ball, and all holds",
          "[filter][contact][bending][whole_step]") {
    constexpr Options options{.limits_stretch = true, .integrates = true, .keeps_contacts = true, .bends = true};
    constexpr int frames = 240;
    double last_corner = -1.0;
    for (const float rigidity : {1e-3f, 2e-2f, 2e-1f}) {
        MovingCloth cloth = sheet_over_ball(25);
        StrainLimiter limiter(device().context, device().id, cloth.topology, options);
        const Parameters parameters{.stretch_ceiling = 1.1f,
                                    .acceleration = {0.0f, -9.81f, 0.0f},
                                    .damping = 2.0f,
                                    .bending = rigidity,
                                    .bending_iterations = 4};
        double in_motion = 0.0, at_rest = 0.0, stretch = 0.0;  // greatest, of areas their change
        for (int frame = 0; frame < frames; ++frame) {
            CAPTURE(rigidity, frame);
            const Ended end = step_over_ball(limiter, cloth, options, parameters);
            double& area_change = frame < frames / 2 ? in_motion : at_rest;
            area_change = std::max(area_change, static_cast<double>(end.stats.max_area_change));
            stretch = std::max(stretch, static_cast<double>(end.stats.max_stretch));
        }
        CAPTURE(rigidity, stretch);
        CHECK(in_motion < 0.01);
        CHECK(at_rest < 0.002);
        CHECK(stretch < 1.11);
        CHECK(kinetic_energy_of(cloth) < 1e-3);  // J; it fell some 0.3 m with 0.2 kg: 0.6 J
        const double corner = cloth.positions[1];
        CHECK(corner > last_corner + 0.1);
        last_corner = corner;
    }
    CHECK(last_corner > 0.0);  // of the stiffest, which stands out from the ball
}

TEST_CASE("contact: the buffer is asked for with the option, and only then", "[filter][contact]") {
    const MovingCloth cloth = small_cloths()[0];
    const Owned<cl_command_queue> queue = in_order_queue();
    StrainLimiter keeps(device().context, device().id, cloth.topology, filtering);
    StrainLimiter plain(device().context, device().id, cloth.topology);
    const CallerBuffers buffers({&cloth, 1}, filtering);
    Buffers with = buffers.views(), without = with;
    without.contacts = {};
    CHECK_THROWS_WITH(keeps.enqueue(queue.get(), without, tight(12)), Catch::Contains("buffers.contacts"));
    CHECK_THROWS_WITH(plain.enqueue(queue.get(), with, tight(12)),
                      Catch::Contains("buffers.contacts is given, but Options::keeps_contacts is off"));
    CHECK(keeps.options().execution == Execution::many_groups);
}
