// SPDX-License-Identifier: MIT
#include "kernels/free_fall.hpp"
#include "kernels/launch.hpp"
#include "support/tolerances.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

using namespace apsl;
using namespace apsl::test;

namespace {

Build accelerating(std::uint32_t work_group_size) {
    return {.work_group_size = work_group_size, .integrates = true, .acceleration_per_vertex = true};
}

// Numbers of all vertices, and the sizes that round.
struct Compared {
    std::vector<double> errors, sizes;

    void add(float got, double want, double size) {
        errors.push_back(static_cast<double>(got) - want);
        sizes.push_back(std::abs(want) + size);
    }
    void check() const { CHECK(norm(errors) <= elementwise_tolerance(12) * norm(sizes)); }
};

// `action(cloth, n, place, k, i)` of number n = 3v + k of each cloth, with the place of its vertex in the limiter's
// arrays and its number i in the caller's.
template <class Action>
void for_each_number(const Arrays& arrays, const Action& action) {
    std::size_t i = 0;
    for (const Cloth& cloth : arrays.sources)
        for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v, ++i)
            for (std::size_t k = 0; k < 3; ++k) action(cloth, 3 * v + k, arrays.vertex_places[i], k, i);
}

}  // namespace

TEST_CASE("acceleration in predict_positions: each vertex has its own, which the limiter's order keeps",
          "[predict_positions][acceleration]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const Placement& placement : {Placement{3, 0}, Placement{4, 7}}) {
            const std::vector<Cloth> cloths{make_cloth(strip(131), 3), make_cloth(strip(1), 4)};
            Arrays arrays(cloths, Matrix::consistent, falling, 2, false, placement, {5, 2});
            const std::vector<cl_float4> ordered = arrays.accelerations.read();
            arrays.accelerations.write(poison<cl_float4>(ordered.size()));
            arrays.moved.write(poison<cl_float4>(ordered.size()));
            launch::predict_positions(arrays, accelerating(group));
            CAPTURE(group, placement.stride);
            CHECK(same_bytes(ordered, arrays.accelerations.read()));
            const std::vector<cl_float4> moved = arrays.moved.read();
            Compared compared;
            for_each_number(
                arrays, [&](const Cloth& cloth, std::size_t n, std::uint32_t place, std::size_t k, std::size_t) {
                    compared.add(moved[place].s[k], cloth.positions[n] + FreeNumber(cloth, n, parts, true).moved, 0.1);
                });
            compared.check();
        }
}

TEST_CASE("acceleration in start_small_steps and gather_displacements: part by part",
          "[start_small_steps][gather_displacements][acceleration]") {
    for (const std::uint32_t group : work_group_sizes()) {
        const std::vector<Cloth> cloths{make_cloth(strip(300), 1), make_cloth(strip(7), 2)};
        Arrays arrays(cloths, Matrix::consistent, falling, 3, false, {4, 3}, {5, 2});
        arrays.edit_states([](apslk_solve_state& state) { state.solve_iterations = 0; });  // nothing was solved
        arrays.motion.write(arrays.moved.read());  // x̃ and w, as predict_positions leaves them
        const auto check_after = [&](int parts_taken) {
            const std::vector<cl_float4> moved = arrays.moved.read(), motion = arrays.motion.read();
            Compared compared;
            for_each_number(
                arrays, [&](const Cloth& cloth, std::size_t n, std::uint32_t place, std::size_t k, std::size_t) {
                    const FreeNumber want(cloth, n, parts_taken, true);
                    compared.add(moved[place].s[k], cloth.positions[n] + want.moved, 0.1);
                    compared.add(motion[place].s[k], static_cast<double>(falling.time_step) * want.velocity, 0.1);
                });
            CAPTURE(group, parts_taken);
            compared.check();
        };
        launch::start_small_steps(arrays, accelerating(group));
        check_after(1);
        for (int sub_step = 0; sub_step + 1 < parts; ++sub_step) {
            launch::gather_displacements(arrays, accelerating(group), 0, sub_step);
            check_after(sub_step + 2);
        }
        // The last two sub-steps start no part.
        launch::gather_displacements(arrays, accelerating(group), 0, parts - 1);
        launch::gather_displacements(arrays, accelerating(group), 0, parts);
        check_after(parts);
    }
}

TEST_CASE("acceleration in store_step: a discarded call leaves free motion", "[store_step][acceleration]") {
    const std::vector<Cloth> cloths{make_cloth(strip(131), 3), make_cloth(strip(20), 4)};
    const Placement positions{4, 3}, velocities{5, 2};
    Arrays arrays(cloths, Matrix::consistent, falling, 2, false, positions, velocities);
    arrays.motion.write(arrays.moved.read());  // the w of motion is the inverse mass given
    arrays.edit_states([](apslk_solve_state& state) { state.discarded = 1; });
    launch::store_step(arrays, accelerating(64));
    const std::vector<float> moved = arrays.caller_positions.read(), speed = arrays.caller_velocities.read();
    Compared ends, speeds;
    for_each_number(arrays, [&](const Cloth& cloth, std::size_t n, std::uint32_t, std::size_t k, std::size_t i) {
        const FreeNumber want(cloth, n, parts, true);
        ends.add(moved[positions.offset + i * positions.stride + k], cloth.positions[n] + want.moved, 0.1);
        speeds.add(speed[velocities.offset + i * velocities.stride + k], want.velocity, 1.0);
    });
    ends.check();
    speeds.check();
}

TEST_CASE("acceleration in bend_hinges: where vertices were is found back by their own",
          "[bend_hinges][acceleration]") {
    // Motions that own accelerations changed are looked at with them as those without are without.
    Parameters p = falling;
    p.bending = 1e-3f;
    p.stretch_ceiling = 1.1f;
    const auto moments = [&](const std::vector<Cloth>& cloths, bool own) {
        Arrays arrays(cloths, Matrix::consistent, p, 2);
        std::vector<cl_float4> moved = arrays.moved.read(), motion(moved.size());
        for_each_number(arrays,
                        [&](const Cloth& cloth, std::size_t n, std::uint32_t place, std::size_t k, std::size_t) {
                            const FreeNumber after(cloth, n, 1, own);
                            moved[place].s[k] = static_cast<float>(cloth.positions[n] + after.moved);
                            motion[place].s[k] = static_cast<float>(static_cast<double>(p.time_step) * after.velocity);
                            motion[place].s[3] = moved[place].s[3];
                        });
        arrays.moved.write(moved);
        arrays.motion.write(motion);
        launch::bend_hinges(arrays,
                            {.chebyshev = true,
                             .limits_stretch = true,
                             .integrates = true,
                             .bends = true,
                             .acceleration_per_vertex = own},
                            0);
        const std::vector<float> found = arrays.hinge_moments.read();
        return std::vector<double>(found.begin(), found.end());
    };
    const std::vector<Cloth> cloths{make_cloth(grid(9, 11, 1.0, 1.0, Diagonals::alternating), 1),
                                    make_cloth(strip(20), 4)};
    const std::vector<double> own = moments(cloths, true), without = moments(cloths, false);
    CHECK(norm(without) > 0.0);
    CHECK(difference(own, without) <= 2e-4 * norm(without));
}
