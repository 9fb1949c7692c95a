// SPDX-License-Identifier: MIT
#include "kernels/launch.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;

namespace {

void check_predicted(Arrays& arrays, const Build& build) {
    arrays.moved.write(poison<cl_float4>(arrays.moved.size()));
    arrays.stats.write(poison<apslk_stats>(arrays.stats.size()));
    std::vector<apslk_solve_state> states = poison<apslk_solve_state>(arrays.states.size());
    for (apslk_solve_state& state : states) state.adaptive_factor = 4.0f;
    arrays.states.write(states);
    launch::predict_positions(arrays, build);

    const std::vector<cl_float4> moved = arrays.moved.read();
    const float time_step = arrays.parameters.read()[0].time_step;
    std::size_t i = 0;
    std::size_t wrong = 0;
    for (const Cloth& cloth : arrays.sources)
        for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v, ++i) {
            // OpenCL's fma is correctly rounded: the host's gives the same bits.
            const cl_float4& x = moved[arrays.vertex_places[i]];
            for (std::size_t k = 0; k < 3; ++k)
                wrong += x.s[k] != std::fma(time_step, static_cast<float>(cloth.velocities[3 * v + k]),
                                            static_cast<float>(cloth.positions[3 * v + k]));
            wrong += x.s[3] != static_cast<float>(cloth.inverse_masses[v]);
        }
    CHECK(wrong == 0);
    for (const apslk_solve_state& state : arrays.states.read()) {
        CHECK(state.stopped == 0);
        CHECK(state.adaptive_factor == 4.0f);  // outlives the call
    }
    for (const apslk_stats& stats : arrays.stats.read()) {
        CHECK(stats.sub_steps == 0);
        CHECK(stats.iterations == 0);
        CHECK(stats.residual == 0.0f);
        CHECK(stats.status == APSLK_STATUS_OK);
    }
}

}  // namespace

TEST_CASE("predict_positions: awkward sizes in every work-group size", "[predict_positions]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const std::uint32_t size : awkward_sizes(group)) {
            CAPTURE(group, size);
            const std::vector<Cloth> cloths{make_cloth(strip(size), 1), make_cloth(strip(7), 2)};
            Arrays arrays(cloths, Matrix::printed, paper_setting, 3);
            check_predicted(arrays, {.work_group_size = group});
        }
}

TEST_CASE("predict_positions: strides and offsets of the caller's buffers", "[predict_positions]") {
    const std::vector<Cloth> cloths{make_cloth(strip(131), 3), make_cloth(strip(1), 4)};
    for (const auto& [positions, velocities] :
         {std::pair<Placement, Placement>{{4, 0}, {4, 0}}, {{5, 7}, {3, 2}}, {{3, 1}, {5, 33}}}) {
        CAPTURE(positions.stride, positions.offset, velocities.stride, velocities.offset);
        Arrays arrays(cloths, Matrix::printed, paper_setting, 2, false, positions, velocities);
        check_predicted(arrays, {});
    }
}
