// SPDX-License-Identifier: MIT
#include "kernels/launch.hpp"
#include "support/tolerances.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;

namespace {

// Corrected positions a little off the predicted ones, as a solve leaves them.
void move_points(Arrays& arrays, std::uint32_t seed) {
    const float time_step = arrays.parameters.read()[0].time_step;
    std::vector<cl_float4> moved = arrays.moved.read();
    const std::vector<double> moves = random_numbers(3 * moved.size(), -0.02, 0.02, seed);
    std::size_t i = 0;
    for (const Cloth& cloth : arrays.sources)
        for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v, ++i)
            for (std::size_t k = 0; k < 3; ++k)
                moved[arrays.vertex_places[i]].s[k] = static_cast<float>(cloth.positions[3 * v + k] + moves[3 * i + k] +
                                                                         time_step * cloth.velocities[3 * v + k]);
    arrays.moved.write(moved);
}

void check_velocities(Arrays& arrays, const Build& build) {
    const std::vector<float> before = arrays.caller_velocities.read();
    const std::vector<cl_float4> moved = arrays.moved.read();
    const double time_step = static_cast<double>(arrays.parameters.read()[0].time_step);
    launch::update_velocities(arrays, build);
    const std::vector<float> after = arrays.caller_velocities.read();

    const Placement at = arrays.velocity_placement;
    std::vector<float> expected_untouched = before;
    std::vector<double> errors, bounds;
    std::size_t i = 0;
    for (const Cloth& cloth : arrays.sources)
        for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v, ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t n = at.offset + i * at.stride + k;
                if (cloth.inverse_masses[v] == 0.0) continue;
                expected_untouched[n] = after[n];
                const double x = static_cast<double>(moved[arrays.vertex_places[i]].s[k]);
                const double end = cloth.positions[3 * v + k] + time_step * cloth.velocities[3 * v + k];
                const double expected = cloth.velocities[3 * v + k] + (x - end) / time_step;
                errors.push_back(static_cast<double>(after[n]) - expected);
                // The predicted position is rounded at its own size, and that error is divided by the time step.
                bounds.push_back(std::abs(end) / time_step + std::abs(expected) + std::abs(before[n]));
            }
    CHECK(norm(errors) <= elementwise_tolerance(3) * norm(bounds));
    // Pinned vertices, gaps between elements and what lies before the first keep every bit.
    CHECK(same_bytes(expected_untouched, after));
}

}  // namespace

TEST_CASE("update_velocities: awkward sizes in every work-group size", "[update_velocities]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const std::uint32_t size : awkward_sizes(group)) {
            CAPTURE(group, size);
            const std::vector<Cloth> cloths{make_cloth(strip(size), 1), make_cloth(strip(7), 2)};
            Arrays arrays(cloths, Matrix::printed, paper_setting, 3);
            move_points(arrays, 5);
            check_velocities(arrays, {.work_group_size = group});
        }
}

TEST_CASE("update_velocities: strides and offsets of the caller's buffers", "[update_velocities]") {
    const std::vector<Cloth> cloths{make_cloth(strip(131), 3), make_cloth(strip(1), 4)};
    for (const auto& [positions, velocities] :
         {std::pair<Placement, Placement>{{4, 0}, {4, 0}}, {{5, 7}, {3, 2}}, {{3, 1}, {5, 33}}}) {
        CAPTURE(positions.stride, positions.offset, velocities.stride, velocities.offset);
        Arrays arrays(cloths, Matrix::printed, paper_setting, 2, false, positions, velocities);
        move_points(arrays, 6);
        check_velocities(arrays, {});
    }
}

TEST_CASE("update_velocities: a pinned vertex keeps every bit of its velocity", "[update_velocities]") {
    std::vector<Cloth> cloths{make_cloth(strip(20), 3)};
    cloths[0].inverse_masses.assign(22, 0.0);
    for (std::size_t n = 0; n < cloths[0].velocities.size(); n += 2) cloths[0].velocities[n] = -0.0;
    Arrays arrays(cloths, Matrix::printed, paper_setting, 2);
    move_points(arrays, 6);
    const std::vector<float> before = arrays.caller_velocities.read();
    REQUIRE(std::signbit(before[0]));
    launch::update_velocities(arrays, {});
    CHECK(same_bytes(before, arrays.caller_velocities.read()));
}

TEST_CASE("update_velocities: what no solve moved keeps its velocity, and a discarded call all of them",
          "[update_velocities]") {
    const std::vector<Cloth> cloths{make_cloth(strip(300), 3)};
    Arrays arrays(cloths, Matrix::printed, paper_setting, 2);
    const std::vector<float> before = arrays.caller_velocities.read();
    launch::predict_positions(arrays, {});
    launch::update_velocities(arrays, {});
    CHECK(same_bytes(before, arrays.caller_velocities.read()));

    move_points(arrays, 7);
    arrays.edit_states([](apslk_solve_state& state) { state.discarded = 1; });
    launch::update_velocities(arrays, {});
    CHECK(same_bytes(before, arrays.caller_velocities.read()));
}

TEST_CASE("update_velocities: after small steps what its corrections add up to, and nothing else",
          "[update_velocities][exact_division]") {
    const std::vector<Cloth> cloths{make_cloth(strip(300), 3)};
    Arrays arrays(cloths, Matrix::printed, {.sub_steps = 4, .stepping = Stepping::small_steps}, 2, false, {4, 3},
                  {5, 2});
    std::vector<cl_float4> total_correction(arrays.total_correction.size(), cl_float4{{0.0f, 0.0f, 0.0f, 0.0f}});
    const std::uint32_t place = arrays.vertex_places[18];
    total_correction[place] = {{0.5f, -0.25f, 0.125f, 0.0f}};
    arrays.total_correction.write(total_correction);
    move_points(arrays, 7);  // where small steps ended does not matter
    std::vector<float> expected = arrays.caller_velocities.read();
    REQUIRE(cloths[0].inverse_masses[18] > 0.0);
    const float time_step = arrays.parameters.read()[0].time_step;
    for (std::size_t k = 0; k < 3; ++k) expected[2 + 5 * 18 + k] += total_correction[place].s[k] * (1.0f / time_step);
    launch::update_velocities(arrays, {});
    CHECK(same_bytes(expected, arrays.caller_velocities.read()));
}
