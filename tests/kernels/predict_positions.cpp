// SPDX-License-Identifier: MIT
#include "kernels/launch.hpp"
#include "support/tolerances.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

using namespace apsl;
using namespace apsl::test;

namespace {

constexpr Parameters walk{.sub_steps = 5, .stepping = Stepping::small_steps};

void check_predicted(Arrays& arrays, const Build& build) {
    arrays.predicted.write(poison<cl_float4>(arrays.predicted.size()));
    arrays.motion.write(poison<cl_float4>(arrays.motion.size()));
    arrays.partials.write(poison<float>(arrays.partials.size()));
    arrays.stats.write(poison<apsl_stats>(arrays.stats.size()));
    std::vector<apsl_solve_state> states = poison<apsl_solve_state>(arrays.states.size());
    for (apsl_solve_state& state : states) state.adaptive_factor = 4.0f;
    arrays.states.write(states);
    launch::predict_positions(arrays, build);

    const std::vector<cl_float4> predicted = arrays.predicted.read();
    const float time_step = arrays.parameters.read()[0].time_step;
    std::size_t i = 0;
    std::size_t wrong = 0;
    const std::vector<cl_float4> motion = arrays.motion.read();
    const bool walking = arrays.parameters.read()[0].walked > 0;
    if (!walking) CHECK(same_bytes(motion, poison<cl_float4>(motion.size())));
    for (std::size_t c = 0; c < arrays.cloth_count(); ++c) {
        const Cloth& cloth = arrays.sources[c];
        double root_masses = 0.0, movable = 0.0, extent = 0.0;
        for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v, ++i) {
            if (cloth.inverse_masses[v] > 0.0) {
                root_masses += std::sqrt(1.0 / cloth.inverse_masses[v]);
                movable += 1.0;
            }
            // OpenCL's fma is correctly rounded: the host's gives the same bits.
            const cl_float4& x = predicted[arrays.vertex_places[i]];
            for (std::size_t k = 0; k < 3; ++k)
                wrong += x.s[k] != std::fma(time_step, static_cast<float>(cloth.velocities[3 * v + k]),
                                            static_cast<float>(cloth.positions[3 * v + k]));
            wrong += x.s[3] != static_cast<float>(cloth.inverse_masses[v]);
            for (std::size_t k = 0; k < 3; ++k) extent = std::max(extent, std::abs(static_cast<double>(x.s[k])));
            if (!walking) continue;
            for (std::size_t k = 0; k < 3; ++k)
                wrong += motion[arrays.vertex_places[i]].s[k] != static_cast<float>(cloth.positions[3 * v + k]);
            wrong += motion[arrays.vertex_places[i]].s[3] != static_cast<float>(cloth.inverse_masses[v]);
        }
        const auto sum = [&](int kind) {
            const std::vector<double> parts = arrays.partials_of(c, kind);
            return std::accumulate(parts.begin(), parts.end(), 0.0);
        };
        CHECK(std::abs(sum(APSL_PARTIAL_ROOT_MASSES) - root_masses) <=
              sum_tolerance(2, cloth.inverse_masses.size()) * root_masses);
        CHECK(sum(APSL_PARTIAL_MOVABLE) == movable);
        CHECK(sum(APSL_PARTIAL_BAD_VERTICES) == 0.0);
        const std::vector<double> extents = arrays.partials_of(c, APSL_PARTIAL_EXTENT);
        CHECK(*std::max_element(extents.begin(), extents.end()) == extent);
    }
    CHECK(wrong == 0);
    for (const apsl_solve_state& state : arrays.states.read()) {
        CHECK(state.stopped == 0);
        CHECK(state.adaptive_factor == 4.0f);  // outlives the call
    }
    for (const apsl_stats& stats : arrays.stats.read()) {
        CHECK(stats.sub_steps == 0);
        CHECK(stats.cg_iterations == 0);
        CHECK(stats.residual == 0.0f);
        CHECK(stats.status == APSL_STATUS_OK);
    }
}

}  // namespace

TEST_CASE("predict_positions: awkward sizes in every work-group size", "[predict_positions]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const std::uint32_t size : awkward_sizes(group)) {
            CAPTURE(group, size);
            const std::vector<Cloth> cloths{make_cloth(strip(size), 1), make_cloth(strip(7), 2)};
            for (const Parameters& parameters : {paper_setting, walk}) {
                Arrays arrays(cloths, Matrix::printed, parameters, 3);
                check_predicted(arrays, {.work_group_size = group});
            }
        }
}

TEST_CASE("predict_positions: strides and offsets of the caller's buffers", "[predict_positions]") {
    const std::vector<Cloth> cloths{make_cloth(strip(131), 3), make_cloth(strip(1), 4)};
    for (const auto& [positions, velocities] :
         {std::pair<Placement, Placement>{{4, 0}, {4, 0}}, {{5, 7}, {3, 2}}, {{3, 1}, {5, 33}}}) {
        CAPTURE(positions.stride, positions.offset, velocities.stride, velocities.offset);
        for (const Parameters& parameters : {paper_setting, walk}) {
            Arrays arrays(cloths, Matrix::printed, parameters, 2, false, positions, velocities);
            check_predicted(arrays, {});
        }
    }
}
