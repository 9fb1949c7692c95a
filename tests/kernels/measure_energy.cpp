// SPDX-License-Identifier: MIT
#include "kernels/free_fall.hpp"
#include "kernels/launch.hpp"
#include "reference/energy_bound.hpp"
#include "support/tolerances.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numeric>

using namespace apsl;
using namespace apsl::test;

namespace {

/// The end of a step of acceleration and damping alone.
struct Free {
    std::vector<double> positions, velocities;

    Free(const Cloth& cloth, bool own) {
        for (std::size_t n = 0; n < cloth.velocities.size(); ++n) {
            const FreeNumber number(cloth, n, parts, own);
            positions.push_back(cloth.positions[n] + number.moved);
            velocities.push_back(number.velocity);
        }
    }
};

/// Σ m |u − frame|² of what can move, of vertices that `counts` says.
double squares(const Cloth& cloth, const std::vector<double>& velocities, const Eigen::Vector3d& frame,
               const std::function<bool(std::size_t)>& counts) {
    double sum = 0.0;
    for (std::size_t n = 0; n < velocities.size(); ++n)
        if (cloth.inverse_masses[n / 3] > 0.0 && counts(n / 3))
            sum += std::pow(velocities[n] - frame[static_cast<Eigen::Index>(n % 3)], 2) / cloth.inverse_masses[n / 3];
    return sum;
}

double sum_of(const std::vector<double>& numbers) {
    return std::accumulate(numbers.begin(), numbers.end(), 0.0);
}

/// Where small steps ended, [3V] of all cloths.
struct End {
    std::vector<double> velocities, changes;  ///< m/s; m, of positions over the step
};

/// Random ends: positions, and Δt u with the inverse mass.
End end_small_steps(Arrays& arrays) {
    std::vector<cl_float4> motion = arrays.motion.read(), moved = arrays.moved.read();
    const End end{random_numbers(3 * motion.size(), -4.0, 4.0, 5), random_numbers(3 * motion.size(), -0.1, 0.1, 6)};
    std::size_t i = 0;
    for (const Cloth& cloth : arrays.sources)
        for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v, ++i) {
            cl_float4& step = motion[arrays.vertex_places[i]];
            cl_float4& position = moved[arrays.vertex_places[i]];
            for (std::size_t k = 0; k < 3; ++k) {
                step.s[k] = falling.time_step * static_cast<float>(end.velocities[3 * i + k]);
                position.s[k] = static_cast<float>(cloth.positions[3 * v + k] + end.changes[3 * i + k]);
            }
            step.s[3] = static_cast<float>(cloth.inverse_masses[v]);
        }
    arrays.motion.write(motion);
    arrays.moved.write(moved);
    return end;
}

/// Σ m Δu·(2 Δx/Δt − u − u_f): what acceleration, which adds Δu to the u that a step starts with, gives over Δx in
/// place of what it gives to the free step, which ends with u_f.
double followed(const Cloth& cloth, const Free& free, const double* changes) {
    const double time_step{falling.time_step}, kept = std::exp(-static_cast<double>(falling.damping) * time_step);
    double sum = 0.0;
    for (std::size_t n = 0; n < free.velocities.size(); ++n) {
        const double given = cloth.velocities[n], ends = free.velocities[n];
        if (cloth.inverse_masses[n / 3] > 0.0)
            sum += (ends - kept * given) * (2.0 * changes[n] / time_step - given - ends) / cloth.inverse_masses[n / 3];
    }
    return sum;
}

/// kg m²/s², what bodies add to vertices that they pull along.
double check_measured(const std::vector<Cloth>& cloths, const Build& build) {
    Arrays arrays(cloths, Matrix::consistent, falling, 3, false, {4, 3}, {5, 2});
    launch::predict_positions(arrays, build);
    const End end = end_small_steps(arrays);
    launch::measure_energy(arrays, build);
    std::size_t first = 0;
    double pulled_along = 0.0;
    for (std::size_t c = 0; c < cloths.size(); ++c) {
        const Cloth& cloth = cloths[c];
        CAPTURE(build.work_group_size, build.keeps_contacts, build.acceleration_per_vertex, c);
        const Free free(cloth, build.acceleration_per_vertex);
        const reference::Drive want = reference::drive<double>(
            {.positions = {},
             .velocities = {},
             .inverse_masses = cloth.inverse_masses,
             .rest_areas = {},
             .regularization = {},
             .contacts = build.keeps_contacts ? std::span<const double>(cloth.contacts) : std::span<const double>()},
            {free.positions, free.velocities, static_cast<double>(falling.time_step)});
        const std::size_t count = free.velocities.size();
        const std::vector<double> left(end.velocities.begin() + static_cast<std::ptrdiff_t>(3 * first),
                                       end.velocities.begin() + static_cast<std::ptrdiff_t>(3 * first + count));
        double mass = 0.0;
        for (const double w : cloth.inverse_masses) mass += w > 0.0 ? 1.0 / w : 0.0;
        const double tolerance = 1e-4, size = 30.0;
        const apslk_solve_state state = arrays.states.read()[c];
        for (std::size_t k = 0; k < 3; ++k)
            CHECK(static_cast<double>(state.drive[k]) ==
                  Approx(want.velocity[static_cast<Eigen::Index>(k)]).margin(tolerance * size));
        CHECK((state.flies != 0) == want.flies);
        CHECK(static_cast<double>(state.mass) == Approx(mass).epsilon(tolerance));
        CHECK(static_cast<double>(state.pins) == Approx(want.pins).epsilon(tolerance).margin(tolerance));
        const auto sum = [&](int kind) { return sum_of(arrays.partials_of(c, kind)); };
        const reference::AddedByBodies added{sum(APSLK_PARTIAL_ADDED_ALONE), sum(APSLK_PARTIAL_ADDED_ALONG),
                                             sum(APSLK_PARTIAL_PULLING)};
        CHECK(added.of_cloth(mass) == Approx(want.bodies).epsilon(tolerance).margin(tolerance));
        pulled_along += added.along;
        const auto all = [](std::size_t) { return true; };
        const double of_free = squares(cloth, free.velocities, want.velocity, all);
        CHECK(sum(APSLK_PARTIAL_FREE_ENERGY) == Approx(of_free + followed(cloth, free, end.changes.data() + 3 * first))
                                                    .margin(tolerance * (of_free + 1.0)));
        CHECK(sum(APSLK_PARTIAL_LEFT_ENERGY) ==
              Approx(squares(cloth, left, want.velocity, all)).epsilon(tolerance).margin(1e-6));
        double gained = 0.0;  // random motion: about half of the vertices did
        for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v) {
            const auto one = [&](std::size_t i) { return i == v; };
            gained += std::max(
                squares(cloth, left, want.velocity, one) - squares(cloth, free.velocities, want.velocity, one), 0.0);
        }
        CHECK(sum(APSLK_PARTIAL_GAINED_ENERGY) == Approx(gained).epsilon(tolerance).margin(1e-6));
        CHECK(sum(APSLK_PARTIAL_BENDING_ENERGY) == 0.0);
        CHECK(sum(APSLK_PARTIAL_BENDING_LEFT) == 0.0);
        first += cloth.topology->vertex_count();
    }
    return pulled_along;
}

}  // namespace

TEST_CASE("measure_energy: the reference's frame, and the energies of the free and of the limited step in it",
          "[measure_energy][predict_positions][energy]") {
    std::vector<Cloth> cloths{make_cloth(strip(131), 3), make_cloth(strip(1), 4)};
    std::vector<Cloth> free{make_cloth(strip(70), 5), make_cloth(strip(131), 6)};
    for (Cloth& cloth : free)
        for (double& w : cloth.inverse_masses) w = w > 0.0 ? w : 2.0;
    double pulled_along = 0.0;
    for (const std::uint32_t group : work_group_sizes())
        for (const bool keeps_contacts : {false, true})
            for (const bool own_accelerations : {false, true})
                for (const std::vector<Cloth>& some : {cloths, free})
                    pulled_along += check_measured(some, {.work_group_size = group,
                                                          .integrates = true,
                                                          .keeps_contacts = keeps_contacts,
                                                          .acceleration_per_vertex = own_accelerations});
    CHECK(pulled_along > 0.0);
}
