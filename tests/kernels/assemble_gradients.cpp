// SPDX-License-Identifier: MIT
#include "kernels/launch.hpp"
#include "support/tolerances.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <tuple>

using namespace apsl;
using namespace apsl::test;

namespace {

double sum(const std::vector<double>& numbers) {
    return std::accumulate(numbers.begin(), numbers.end(), 0.0);
}

// What the groups report of the areas, against the reference's areas.
void check_area_sums(const Arrays& arrays) {
    for (std::size_t c = 0; c < arrays.cloth_count(); ++c) {
        const Cloth& cloth = arrays.sources[c];
        const std::size_t count = cloth.rest_areas.size();
        double greatest = 0.0, squares = 0.0, capped = 0.0, weights = 0.0, area_ratio = 0.0;
        for (std::size_t a = 0; a < count; ++a) {
            const double area = arrays.solves[c].geometry[a].area;
            const double change = std::abs(area - cloth.rest_areas[a]) / cloth.rest_areas[a];
            greatest = std::max(greatest, change);
            squares += cloth.rest_areas[a] * change * change;
            capped += cloth.rest_areas[a] * std::min(change, 1.0) * std::min(change, 1.0);
            weights += cloth.rest_areas[a];
            area_ratio = std::max(area_ratio, area / cloth.rest_areas[a]);
        }
        const std::vector<double> greatest_got = arrays.partials_of(c, APSLK_PARTIAL_MAX_CHANGE);
        // An area comes of about ten roundings, and A − A⁰ keeps the absolute error of A.
        const double absolute = elementwise_tolerance(10) * area_ratio;
        CHECK(std::abs(*std::max_element(greatest_got.begin(), greatest_got.end()) - greatest) <= absolute);
        const double rms = std::sqrt(squares / weights);
        const double got = std::sqrt(sum(arrays.partials_of(c, APSLK_PARTIAL_SQUARED_CHANGE)) / weights);
        CHECK(std::abs(got - rms) <= absolute + sum_tolerance(4, count) * rms);
        const double capped_rms = std::sqrt(capped / weights);
        const double capped_got = std::sqrt(sum(arrays.partials_of(c, APSLK_PARTIAL_CAPPED_CHANGE)) / weights);
        CHECK(std::abs(capped_got - capped_rms) <= absolute + sum_tolerance(4, count) * capped_rms);
        CHECK(std::abs(sum(arrays.partials_of(c, APSLK_PARTIAL_MEASURED)) - weights) <=
              sum_tolerance(1, count) * weights);
        CHECK(sum(arrays.partials_of(c, APSLK_PARTIAL_NOT_FINITE)) == 0.0);
    }
}

// What vector loads of later kernels read beyond a cloth's last triangle.
void check_padding(const Arrays& arrays) {
    for (const DeviceArray<float>* array : {&arrays.residual, &arrays.scaled_diagonal})
        for (const float number : arrays.padding_of(array->read())) CHECK(number == 0.0f);
}

void check_gradients(const Arrays& arrays, bool alpha_per_triangle) {
    const std::vector<Gradients> gradients = arrays.gradients.read();
    const std::vector<float> residual = arrays.residual.read();
    const double common_alpha = static_cast<double>(arrays.parameters.read()[0].regularization);
    for (std::size_t c = 0; c < arrays.cloth_count(); ++c) {
        const ScaledSolve& solve = arrays.solves[c];
        std::vector<double> residual_scale, areas;
        double farthest = 0.0;
        for (std::size_t a = 0; a < solve.scale.size(); ++a) {
            const Gradients& stored = gradients[arrays.triangle_places[c][a]];
            const double alpha = alpha_per_triangle ? arrays.sources[c].regularization[a] : common_alpha;
            for (std::size_t corner = 0; corner < 3; ++corner) {
                for (int k = 0; k < 3; ++k)
                    farthest = std::max(farthest, std::abs(stored.corner[corner].s[k] * gradient_unit -
                                                           solve.scaled_gradients[a][corner][k]));
                CHECK(stored.corner[corner].s[3] == 0);
            }
            CHECK(std::abs(static_cast<double>(stored.shift) - (alpha - 1.0) / alpha) <= elementwise_tolerance(2));
            const double stiffening = solve.scale[a] > 0.0 ? 1.0 / (solve.scale[a] * solve.geometry[a].area) : 0.0;
            CHECK(std::abs(static_cast<double>(stored.stiffening) - stiffening) <=
                  elementwise_tolerance(40) * stiffening);
            residual_scale.push_back(solve.scale[a] * solve.geometry[a].area);
            areas.push_back(solve.geometry[a].area);
        }
        // Half a unit, and what goes in: edge, cross product, normal, cross product, scale, about thirty roundings of
        // numbers of at most 1.
        CHECK(farthest <= 0.5 * gradient_unit + elementwise_tolerance(30));
        const double residual_error = elementwise_tolerance(20) * norm(residual_scale);
        CHECK(difference(arrays.of_cloth(residual, c), solve.right_hand_side) <= residual_error);
        const double scaled_norm = std::sqrt(sum(arrays.partials_of(c, APSLK_PARTIAL_SCALED_RESIDUAL_EVEN)));
        CHECK(std::abs(scaled_norm - norm(solve.right_hand_side)) <=
              residual_error + sum_tolerance(2, solve.scale.size()) * scaled_norm);
        // Unscaled, A − A⁰ of the triangles that can move: the error of an area, as above.
        const double plain_norm = std::sqrt(sum(arrays.partials_of(c, APSLK_PARTIAL_RESIDUAL_EVEN)));
        const double expected = std::sqrt(arrays.unscaled_squared(c, solve.right_hand_side));
        CHECK(std::abs(plain_norm - expected) <=
              elementwise_tolerance(20) * norm(areas) + sum_tolerance(2, solve.scale.size()) * plain_norm);
        CHECK(difference(arrays.of_cloth(arrays.scaled_diagonal.read(), c), solve.scaled_diagonal) <=
              elementwise_tolerance(12) * norm(solve.scaled_diagonal));
    }
    check_padding(arrays);
}

void poison_outputs(Arrays& arrays) {
    arrays.gradients.write(poison<Gradients>(arrays.gradients.size()));
    arrays.residual.write(Arrays::with_stretches(arrays.poisoned_triangles()));
    arrays.scaled_diagonal.write(Arrays::with_stretches(arrays.poisoned_triangles()));
    arrays.partials.write(poison<float>(arrays.partials.size()));
}

}  // namespace

TEST_CASE("assemble_gradients: gradients, residual and sums, awkward sizes in every work-group size",
          "[assemble_gradients]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const std::uint32_t size : awkward_sizes(group)) {
            CAPTURE(group, size);
            const std::vector<Cloth> cloths{make_cloth(strip(size), 1), make_cloth(tetrahedron(), 2)};
            Arrays arrays(cloths, Matrix::printed, paper_setting, 3, false, {3, size % 2});
            poison_outputs(arrays);
            launch::assemble_gradients(arrays, {.work_group_size = group});
            check_gradients(arrays, false);
            check_area_sums(arrays);
        }
}

TEST_CASE("assemble_gradients: any mesh, alpha per triangle, the same bytes twice", "[assemble_gradients]") {
    const Build build{.alpha_per_triangle = true};
    const std::vector<Cloth> cloths{make_cloth(grid(17, 13, 1.0, 2.0, Diagonals::random), 1), make_cloth(book(4), 2),
                                    make_cloth(fan(9), 3), make_cloth(right_triangle(), 4)};
    Arrays arrays(cloths, Matrix::printed, paper_setting, 2, true, {3, 5});
    poison_outputs(arrays);
    launch::assemble_gradients(arrays, build);
    check_gradients(arrays, true);
    check_area_sums(arrays);

    const auto gradients = arrays.gradients.read();
    const auto residual = arrays.residual.read();
    const auto partials = arrays.partials.read();
    poison_outputs(arrays);
    launch::assemble_gradients(arrays, build);
    CHECK(same_bytes(gradients, arrays.gradients.read()));
    CHECK(same_bytes(residual, arrays.residual.read()));
    CHECK(same_bytes(partials, arrays.partials.read()));
}

TEST_CASE("assemble_gradients: writes no triangle of a stopped cloth", "[assemble_gradients]") {
    const std::vector<Cloth> cloths{make_cloth(strip(100), 1)};
    Arrays arrays(cloths, Matrix::printed, paper_setting, 2);
    poison_outputs(arrays);
    arrays.edit_states([](apslk_solve_state& state) { state.stopped = 1; });
    launch::assemble_gradients(arrays, {});
    CHECK(same_bytes(arrays.gradients.read(), poison<Gradients>(arrays.gradients.size())));
    CHECK(same_bytes(arrays.residual.read(), Arrays::with_stretches(arrays.poisoned_triangles())));
}

TEST_CASE("assemble_gradients: a triangle without area, free vertices or rest area has no part in the solve",
          "[assemble_gradients]") {
    std::vector<Cloth> cloths{make_cloth(strip(9), 1)};
    for (std::size_t k = 0; k < 3; ++k) {
        cloths[0].positions[3 + k] = cloths[0].positions[k];  // triangle 0 has no area
        cloths[0].inverse_masses[4 + k] = 0.0;                // triangle 4 is pinned
    }
    cloths[0].rest_areas[8] = 0.0;
    for (const std::uint32_t group : {1u, 64u}) {
        Arrays arrays(cloths, Matrix::printed, paper_setting, 1);
        poison_outputs(arrays);
        launch::assemble_gradients(arrays, {.work_group_size = group});
        const std::vector<Gradients> gradients = arrays.gradients.read();
        const std::vector<double> residual = arrays.of_cloth(arrays.residual.read(), 0);
        for (const std::size_t a : {0, 4, 8})
            for (const cl_short4& corner : gradients[arrays.triangle_places[0][a]].corner)
                for (const cl_short component : corner.s) CHECK(component == 0);
        CHECK(residual[4] == 0.0);
        CHECK(residual[8] == 0.0);
        double measured = 0.0;
        for (std::size_t a = 0; a < 8; ++a) measured += cloths[0].rest_areas[a];
        CHECK(arrays.partials_of(0, APSLK_PARTIAL_MEASURED)[0] == Approx(measured).epsilon(1e-6));
        CHECK(arrays.partials_of(0, APSLK_PARTIAL_NOT_FINITE)[0] == 0.0);
        CHECK(std::isfinite(arrays.partials_of(0, APSLK_PARTIAL_SQUARED_CHANGE)[0]));
        CHECK(std::isfinite(arrays.partials_of(0, APSLK_PARTIAL_RESIDUAL_EVEN)[0]));
    }
}

TEST_CASE("assemble_gradients: alpha as the adaptive factor raises it", "[assemble_gradients]") {
    const std::vector<Cloth> cloths{make_cloth(strip(50), 1)};
    for (const auto& [alpha, factor, raised] : {std::array{1.2, 1.0, 1.2}, std::array{1.2, 4.0, 1.8},
                                                std::array{1.0, 2.0, 1.05}, std::array{1.01, 8.0, 1.36}}) {
        CAPTURE(alpha, factor);
        Arrays arrays(cloths, Matrix::printed, {.regularization = static_cast<float>(alpha), .sub_steps = 10}, 2);
        arrays.edit_states([&](apslk_solve_state& state) { state.adaptive_factor = static_cast<float>(factor); });
        launch::assemble_gradients(arrays, {});
        std::vector<double> expected = arrays.solves[0].scaled_diagonal;
        for (double& damped : expected) damped *= raised / static_cast<double>(static_cast<float>(alpha));
        CHECK(difference(arrays.of_cloth(arrays.scaled_diagonal.read(), 0), expected) <=
              elementwise_tolerance(14) * norm(expected));
        for (const std::uint32_t place : arrays.triangle_places[0])
            CHECK(std::abs(static_cast<double>(arrays.gradients.read()[place].shift) - (raised - 1.0) / raised) <=
                  elementwise_tolerance(4));
    }
}

TEST_CASE("assemble_gradients: alpha as the schedule has it in each sub-step", "[assemble_gradients]") {
    const std::vector<Cloth> cloths{make_cloth(strip(50), 1)};
    const Parameters rising{.regularization = 1.2f, .sub_steps = 3, .first_regularization = 1.002f};
    const Parameters falling{.regularization = 1.02f, .sub_steps = 3, .first_regularization = 3.0f};
    const Parameters single{.regularization = 1.2f, .sub_steps = 1, .first_regularization = 1.002f};
    const Parameters fixed{.regularization = 1.2f, .sub_steps = 3};
    for (const auto& [parameters, sub_step, expected] : {std::tuple{rising, 0, 1.002},
                                                         {rising, 1, 1.02},
                                                         {rising, 2, 1.2},
                                                         {falling, 0, 3.0},
                                                         {falling, 1, 1.2},
                                                         {falling, 2, 1.02},
                                                         {single, 0, 1.2},
                                                         {fixed, 0, 1.2},
                                                         {fixed, 2, 1.2}}) {
        CAPTURE(parameters.first_regularization, sub_step, expected);
        Arrays arrays(cloths, Matrix::printed, parameters, 2);
        launch::assemble_gradients(arrays, {}, sub_step);
        for (const std::uint32_t place : arrays.triangle_places[0])
            CHECK(std::abs(static_cast<double>(arrays.gradients.read()[place].shift) - (expected - 1.0) / expected) <=
                  elementwise_tolerance(8));
    }
}

TEST_CASE("assemble_gradients: in small steps what is left of the start's error is not asked for, nor growth beyond 4",
          "[assemble_gradients]") {
    const Parameters small_steps{.sub_steps = 5, .stepping = Stepping::small_steps};  // four parts
    Cloth cloth = make_cloth(grid(9, 9, 1.0, 1.0, Diagonals::random), 1);
    for (std::size_t a = 0; a < cloth.rest_areas.size(); a += 5) cloth.rest_areas[a] *= 10.0;
    const std::vector<Cloth> cloths{cloth};
    const std::vector<double> errors = random_numbers(cloth.rest_areas.size(), -1e-2, 1e-2, 3);
    for (const auto& [sub_step, left] : {std::pair{0, 0.75}, std::pair{1, 0.5}, std::pair{3, 0.0}, std::pair{4, 0.0}}) {
        CAPTURE(sub_step);
        Arrays arrays(cloths, Matrix::consistent, small_steps, 2);
        arrays.start_errors.write(arrays.over_triangles([&](std::size_t, std::size_t a) { return errors[a]; }));
        launch::assemble_gradients(arrays, {}, sub_step);
        const ScaledSolve& solve = arrays.solves[0];
        std::vector<double> expected, size;
        std::size_t bounded = 0;
        for (std::size_t a = 0; a < errors.size(); ++a) {
            const double area = solve.geometry[a].area;
            const double asked = area - cloth.rest_areas[a] - left * errors[a];
            bounded += asked < -3.0 * area;
            expected.push_back(solve.scale[a] * std::max(asked, -3.0 * area));
            size.push_back(solve.scale[a] * std::max(area, cloth.rest_areas[a]));
        }
        CHECK(bounded > errors.size() / 10);
        CHECK(bounded < errors.size() / 2);
        CHECK(difference(arrays.of_cloth(arrays.residual.read(), 0), expected) <=
              elementwise_tolerance(20) * norm(size));
    }
}

TEST_CASE("measure_area_change: awkward sizes in every work-group size", "[measure_area_change]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const std::uint32_t size : awkward_sizes(group)) {
            CAPTURE(group, size);
            const std::vector<Cloth> cloths{make_cloth(strip(size), 1), make_cloth(tetrahedron(), 2)};
            Arrays arrays(cloths, Matrix::printed, paper_setting, 3, false, {3, 9});
            arrays.partials.write(poison<float>(arrays.partials.size()));
            launch::measure_area_change(arrays, {.work_group_size = group});
            check_area_sums(arrays);
        }
}

TEST_CASE("measure_step: the whole step's areas, and how far they are off where it starts", "[measure_step]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const std::uint32_t size : awkward_sizes(group)) {
            CAPTURE(group, size);
            const std::vector<Cloth> cloths{make_cloth(strip(size), 1), make_cloth(tetrahedron(), 2)};
            Arrays arrays(cloths, Matrix::consistent, {.sub_steps = 30}, 3, false, {3, 9});
            arrays.partials.write(poison<float>(arrays.partials.size()));
            std::vector<cl_float4> start = arrays.moved.read();  // twice as large, four times the area
            for (cl_float4& vertex : start)
                for (int k = 0; k < 3; ++k) vertex.s[k] *= 2.0f;
            arrays.motion.write(start);
            launch::measure_step(arrays, {.work_group_size = group});
            check_area_sums(arrays);
            const std::vector<float> errors = arrays.start_errors.read();
            for (std::size_t c = 0; c < cloths.size(); ++c)
                for (std::size_t a = 0; a < cloths[c].rest_areas.size(); ++a) {
                    const double area = 4.0 * arrays.solves[c].geometry[a].area;
                    CHECK(std::abs(static_cast<double>(errors[arrays.triangle_places[c][a]]) -
                                   (area - cloths[c].rest_areas[a])) <= elementwise_tolerance(10) * area);
                }
            CHECK(arrays.padding_of(errors) == std::vector<float>(arrays.padding_of(errors).size()));
        }
}

TEST_CASE("measure_area_change: of a whole step, by how much it misses its limits or missed them",
          "[measure_area_change][whole_step][energy]") {
    const std::vector<Cloth> cloths{make_cloth(strip(131), 1), make_cloth(tetrahedron(), 2)};
    for (const std::uint32_t group : work_group_sizes())
        for (const double start : {0.0, 0.1, 40.0}) {
            CAPTURE(group, start);
            Arrays arrays(cloths, Matrix::consistent, paper_setting, 3);
            std::vector<float> errors = arrays.start_errors.read();
            const auto of_start = [&](std::size_t a) { return a % 5 == 2 ? -start : 0.5 * start; };
            for (std::size_t c = 0; c < cloths.size(); ++c)
                for (std::size_t a = 0; a < cloths[c].rest_areas.size(); ++a)
                    errors[arrays.triangle_places[c][a]] = static_cast<float>(of_start(a) * cloths[c].rest_areas[a]);
            arrays.start_errors.write(errors);
            launch::measure_area_change(arrays, {.work_group_size = group, .integrates = true});
            check_area_sums(arrays);
            for (std::size_t c = 0; c < cloths.size(); ++c) {
                double worst = 0.0;
                for (std::size_t a = 0; a < cloths[c].rest_areas.size(); ++a) {
                    const double rest_area = cloths[c].rest_areas[a];
                    if (!(rest_area > 0.0)) continue;
                    const double change = std::abs(arrays.solves[c].geometry[a].area / rest_area - 1.0);
                    worst = std::max({worst, change, std::abs(of_start(a))});
                }
                const std::vector<double> groups = arrays.partials_of(c, APSLK_PARTIAL_WORST_MISS);
                CHECK(*std::max_element(groups.begin(), groups.end()) == Approx(worst).epsilon(1e-5));
            }
            CHECK(same_bytes(arrays.start_errors.read(), errors));
        }
}

TEST_CASE("measure_area_change: what decides counts a triangle by at most 100 %", "[measure_area_change]") {
    Cloth cloth = make_cloth(grid(9, 9, 1.0, 1.0, Diagonals::random), 1);
    for (std::size_t a = 0; a < cloth.rest_areas.size(); a += 4)
        cloth.rest_areas[a] = static_cast<float>(0.05 * cloth.rest_areas[a]);
    const std::vector<Cloth> cloths{cloth};
    Arrays arrays(cloths, Matrix::printed, paper_setting, 2);
    launch::measure_area_change(arrays, {});
    check_area_sums(arrays);
    CHECK(sum(arrays.partials_of(0, APSLK_PARTIAL_CAPPED_CHANGE)) <
          0.1 * sum(arrays.partials_of(0, APSLK_PARTIAL_SQUARED_CHANGE)));
}

TEST_CASE("measure_area_change: counts the triangles that are not finite", "[measure_area_change]") {
    for (const double bad : {std::nan(""), static_cast<double>(INFINITY), -static_cast<double>(INFINITY), 3e38})
        for (const std::uint32_t group : {1u, 64u}) {
            CAPTURE(bad, group);
            const std::vector<Cloth> cloths{make_cloth(strip(40), 1)};
            Arrays arrays(cloths, Matrix::printed, paper_setting, 2);
            std::vector<cl_float4> moved = arrays.moved.read();
            moved[arrays.vertex_places[20]].s[1] = static_cast<float>(bad);  // at three triangles of the strip
            arrays.moved.write(moved);
            launch::measure_area_change(arrays, {.work_group_size = group});
            CHECK(sum(arrays.partials_of(0, APSLK_PARTIAL_NOT_FINITE)) == 3.0);
            launch::assemble_gradients(arrays, {.work_group_size = group});
            CHECK(sum(arrays.partials_of(0, APSLK_PARTIAL_NOT_FINITE)) == 3.0);
        }
}
