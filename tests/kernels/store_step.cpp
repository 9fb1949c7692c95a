// SPDX-License-Identifier: MIT
#include "kernels/free_fall.hpp"
#include "kernels/launch.hpp"
#include "support/tolerances.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;

namespace {

Build integrating(std::uint32_t work_group_size = 64) {
    return {.work_group_size = work_group_size, .integrates = true};
}

// Where small steps ended: random positions, and motions Δt u with the inverse mass.
void end_small_steps(Arrays& arrays, std::uint32_t seed) {
    std::vector<cl_float4> moved = arrays.moved.read(), motion = arrays.motion.read();
    const std::vector<double> numbers = random_numbers(6 * moved.size(), -1.0, 1.0, seed);
    std::size_t i = 0;
    for (const Cloth& cloth : arrays.sources)
        for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v, ++i) {
            const std::uint32_t place = arrays.vertex_places[i];
            for (std::size_t k = 0; k < 3; ++k) {
                moved[place].s[k] = static_cast<float>(numbers[6 * i + k]);
                motion[place].s[k] = static_cast<float>(0.02 * numbers[6 * i + 3 + k]);
            }
            motion[place].s[3] = static_cast<float>(cloth.inverse_masses[v]);
        }
    arrays.moved.write(moved);
    arrays.motion.write(motion);
}

// One number of a caller's array: vertex i of all cloths.
std::size_t place_of(const Placement& at, std::size_t i, std::size_t k) {
    return at.offset + i * at.stride + k;
}

}  // namespace

TEST_CASE("store_step: where small steps ended, strides, offsets and awkward sizes", "[store_step][exact_division]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const auto& [positions, velocities] :
             {std::pair<Placement, Placement>{{3, 0}, {3, 0}}, {{4, 7}, {5, 2}}}) {
            const std::vector<Cloth> cloths{make_cloth(strip(131), 3), make_cloth(strip(1), 4)};
            Arrays arrays(cloths, Matrix::consistent, falling, 2, false, positions, velocities);
            end_small_steps(arrays, 5);
            std::vector<float> end = arrays.caller_positions.read(), speed = arrays.caller_velocities.read();
            const std::vector<cl_float4> moved = arrays.moved.read(), motion = arrays.motion.read();
            const float time_step = falling.time_step;
            std::size_t i = 0;
            for (const Cloth& cloth : cloths)
                for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v, ++i)
                    for (std::size_t k = 0; k < 3; ++k) {
                        float& x = end[place_of(positions, i, k)];
                        float& u = speed[place_of(velocities, i, k)];
                        if (cloth.inverse_masses[v] == 0.0) {  // a pin moves by its velocity, which it keeps
                            x = std::fma(time_step, u, x);
                            continue;
                        }
                        x = moved[arrays.vertex_places[i]].s[k];
                        u = motion[arrays.vertex_places[i]].s[k] * (1.0f / time_step);
                    }
            CAPTURE(group, positions.stride, velocities.stride);
            launch::store_step(arrays, integrating(group));
            CHECK(same_bytes(end, arrays.caller_positions.read()));
            CHECK(same_bytes(speed, arrays.caller_velocities.read()));
        }
}

TEST_CASE(
    "store_step: a vertex that gained energy is led back to its free velocity, in the frame of what drives the cloth",
    "[store_step][energy]") {
    const std::vector<Cloth> cloths{make_cloth(strip(20), 3)};
    for (const float speed_kept : {1.0f, 0.6f}) {
        Arrays arrays(cloths, Matrix::consistent, falling, 2);
        end_small_steps(arrays, 7);
        arrays.edit_states([&](apslk_solve_state& state) {
            state.drive[0] = 1.0f;
            state.drive[1] = -2.0f;
            state.drive[2] = 3.0f;
            state.speed_kept = speed_kept;
            state.gain_kept = 0.25f;
        });
        const std::vector<cl_float4> moved = arrays.moved.read(), motion = arrays.motion.read();
        const std::vector<float> given = arrays.caller_velocities.read();
        launch::store_step(arrays, integrating());
        const std::vector<float> x = arrays.caller_positions.read(), u = arrays.caller_velocities.read();
        const Eigen::Vector3d drive(1.0, -2.0, 3.0);
        std::size_t gained = 0, lost = 0;
        for (std::size_t i = 0; i < u.size() / 3; ++i) {
            CAPTURE(i);
            const std::uint32_t place = arrays.vertex_places[i];
            Eigen::Vector3d velocity, free;
            for (std::size_t k = 0; k < 3; ++k) {
                velocity[static_cast<Eigen::Index>(k)] =
                    static_cast<double>(motion[place].s[k]) / static_cast<double>(falling.time_step);
                free[static_cast<Eigen::Index>(k)] = FreeNumber(cloths[0], 3 * i + k, parts, false).velocity;
            }
            velocity -= drive;
            free -= drive;
            const bool is_pinned = cloths[0].inverse_masses[i] == 0.0;
            const bool has_gained = velocity.squaredNorm() > free.squaredNorm();
            if (!is_pinned) ++(has_gained ? gained : lost);
            const Eigen::Vector3d led_back = has_gained ? Eigen::Vector3d(free + 0.25 * (velocity - free)) : velocity;
            const Eigen::Vector3d want = drive + static_cast<double>(speed_kept) * led_back;
            for (std::size_t k = 0; k < 3; ++k) {
                if (is_pinned) {
                    CHECK(u[3 * i + k] == given[3 * i + k]);
                    continue;
                }
                CHECK(static_cast<double>(u[3 * i + k]) == Approx(want[static_cast<Eigen::Index>(k)]).margin(1e-5));
                CHECK(x[3 * i + k] == moved[place].s[k]);  // positions are as they were corrected
            }
        }
        CHECK(gained > 2);
        CHECK(lost > 2);
    }
}

TEST_CASE("store_step: a discarded call leaves free motion, a diverged one everything", "[store_step]") {
    const std::vector<Cloth> cloths{make_cloth(strip(20), 3)};
    Arrays arrays(cloths, Matrix::consistent, falling, 2);
    end_small_steps(arrays, 6);
    const std::vector<float> x = arrays.caller_positions.read(), u = arrays.caller_velocities.read();

    std::vector<apslk_stats> stats = arrays.stats.read();
    stats[0].status = APSLK_STATUS_DIVERGED;
    arrays.stats.write(stats);
    arrays.edit_states([](apslk_solve_state& state) { state.discarded = 1; });
    launch::store_step(arrays, integrating());
    CHECK(same_bytes(x, arrays.caller_positions.read()));
    CHECK(same_bytes(u, arrays.caller_velocities.read()));

    stats[0].status = APSLK_STATUS_WORSENED;
    arrays.stats.write(stats);
    launch::store_step(arrays, integrating());
    const std::vector<float> moved = arrays.caller_positions.read(), speed = arrays.caller_velocities.read();
    for (std::size_t n = 0; n < x.size(); ++n) {
        const FreeNumber want(cloths[0], n, parts, false);
        CAPTURE(n);
        CHECK(static_cast<double>(moved[n]) == Approx(cloths[0].positions[n] + want.moved).epsilon(1e-5).margin(1e-6));
        CHECK(static_cast<double>(speed[n]) == Approx(want.velocity).epsilon(1e-5).margin(1e-6));
    }
}
