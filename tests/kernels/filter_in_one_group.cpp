// SPDX-License-Identifier: MIT
#include "kernels/launch.hpp"
#include "support/tolerances.hpp"

#include <apsl/reference.hpp>

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;

namespace {

constexpr Parameters tight{.regularization = 1.3f, .sub_steps = 2, .tolerance = 1e-4f, .max_iterations = 100};

// Velocities small enough that the step stretches by a few parts in a hundred.
std::vector<Cloth> cloths_of(std::initializer_list<Mesh> meshes) {
    std::vector<Cloth> cloths;
    for (const Mesh& mesh : meshes) {
        cloths.push_back(make_cloth(mesh, static_cast<std::uint32_t>(cloths.size() + 1)));
        for (double& v : cloths.back().velocities) v *= 0.125;
    }
    return cloths;
}

// What no call has cleared yet: everything the kernel is to write before it reads.
void poison_scratch(Arrays& arrays) {
    arrays.moved.write(poison<cl_float4>(arrays.moved.size()));
    arrays.gradients.write(poison<Gradients>(arrays.gradients.size()));
    arrays.stats.write(poison<apslk_stats>(arrays.stats.size()));
    std::vector<apslk_solve_state> states = poison<apslk_solve_state>(arrays.states.size());
    for (apslk_solve_state& state : states) state.adaptive_factor = 1.0f;
    arrays.states.write(states);
    for (DeviceArray<float>* array : {&arrays.residual, &arrays.scaled_diagonal, &arrays.product})
        array->write(array == &arrays.product ? arrays.poisoned_triangles()
                                              : Arrays::with_stretches(arrays.poisoned_triangles()));
}

void check_filtered(Arrays& arrays, const Build& build, const Parameters& parameters) {
    poison_scratch(arrays);
    const std::vector<float> given = arrays.caller_velocities.read();
    launch::filter_in_one_group(arrays, build);
    const std::vector<float> got = arrays.caller_velocities.read();
    std::vector<float> untouched = given;
    const Placement at = arrays.velocity_placement;
    const auto time_step = static_cast<double>(parameters.time_step);
    std::size_t i = 0;
    for (std::size_t c = 0; c < arrays.cloth_count(); ++c) {
        CAPTURE(c);
        const Cloth& cloth = arrays.sources[c];
        std::vector<double> want = cloth.velocities;
        reference::StrainLimiter limiter(cloth.topology);
        std::span<const double> alpha;
        if (build.alpha_per_triangle) alpha = cloth.regularization;
        limiter.enqueue({cloth.positions, want, cloth.inverse_masses, cloth.rest_areas, alpha}, parameters);
        std::vector<double> filtered, total_correction;
        for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v, ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t n = at.offset + i * at.stride + k;
                filtered.push_back(static_cast<double>(got[n]));
                total_correction.push_back(want[3 * v + k] - cloth.velocities[3 * v + k]);
                if (cloth.inverse_masses[v] > 0.0) untouched[n] = got[n];
            }
        // Both meet the tolerance, and may stop an iteration apart: off by the condition number, about 20, times it.
        // The stored gradients are off likewise. Positions round at their own size, in every sub-step.
        const auto tolerance = static_cast<double>(parameters.tolerance);
        const double solves = 2.0 * 20.0 * (tolerance + stored_product_tolerance) * norm(total_correction);
        const double rounding = elementwise_tolerance(20.0 * (parameters.sub_steps + 1)) *
                                (norm(cloth.positions) / time_step + norm(cloth.velocities));
        CHECK(difference(filtered, want) <= solves + rounding);
        const apslk_stats stats = arrays.stats.read()[c];
        const Stats expected = limiter.read_stats();
        CHECK(stats.sub_steps == expected.sub_steps);
        CHECK(stats.status == static_cast<int>(expected.status));
        CHECK(std::abs(stats.iterations - expected.iterations) <= expected.sub_steps);
        CHECK(stats.residual <= parameters.tolerance);
        CHECK(stats.max_area_change == Approx(expected.max_area_change).epsilon(0.02).margin(1e-4));
        CHECK(stats.rms_area_change == Approx(expected.rms_area_change).epsilon(0.02).margin(1e-4));
    }
    // Pinned vertices, and what lies between vertices.
    CHECK(same_bytes(untouched, got));
    for (const DeviceArray<float>* array : {&arrays.residual, &arrays.scaled_diagonal, &arrays.product})
        for (const float number : arrays.padding_of(array->read())) CHECK(number == 0.0f);
}

}  // namespace

TEST_CASE("filter_in_one_group: awkward sizes in every work-group size", "[filter_in_one_group]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const std::uint32_t size : awkward_sizes(group)) {
            CAPTURE(group, size);
            const std::vector<Cloth> cloths = cloths_of({strip(std::min(size, 600u)), strip(5)});
            Arrays arrays(cloths, Matrix::consistent, tight, 1);
            check_filtered(arrays, {.work_group_size = group}, tight);
        }
}

TEST_CASE("filter_in_one_group: every kind of mesh, strides, offsets, alpha per triangle", "[filter_in_one_group]") {
    const std::vector<Cloth> cloths =
        cloths_of({grid(9, 11, 1.0, 1.0, Diagonals::alternating), grid(6, 5, 1.0, 2.0, Diagonals::random),
                   tetrahedron(), book(4), fan(12), right_triangle()});
    for (const std::uint32_t group : {1u, 64u}) {
        CAPTURE(group);
        Arrays arrays(cloths, Matrix::consistent, tight, 1, true, {4, 3}, {5, 7});
        check_filtered(arrays, {.work_group_size = group, .alpha_per_triangle = true}, tight);
    }
}

TEST_CASE("filter_in_one_group: the same bytes twice", "[filter_in_one_group]") {
    const std::vector<Cloth> cloths = cloths_of({grid(17, 15, 1.0, 1.0, Diagonals::random), tetrahedron()});
    for (const std::uint32_t group : work_group_sizes()) {
        CAPTURE(group);
        Arrays first(cloths, Matrix::consistent, tight, 1), second(cloths, Matrix::consistent, tight, 1);
        for (Arrays* arrays : {&first, &second}) {
            poison_scratch(*arrays);
            launch::filter_in_one_group(*arrays, {.work_group_size = group});
        }
        CHECK(same_bytes(first.caller_velocities.read(), second.caller_velocities.read()));
        CHECK(same_bytes(first.stats.read(), second.stats.read()));
    }
}
