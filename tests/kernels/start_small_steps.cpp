// SPDX-License-Identifier: MIT
#include "kernels/launch.hpp"
#include "support/tolerances.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;

namespace {

constexpr Parameters small_steps{.sub_steps = 5, .stepping = Stepping::small_steps};  // four parts

}  // namespace

TEST_CASE("start_small_steps: a part of the step, awkward sizes in every work-group size", "[start_small_steps]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const std::uint32_t size : awkward_sizes(group)) {
            CAPTURE(group, size);
            const std::vector<Cloth> cloths{make_cloth(strip(size), 1), make_cloth(strip(7), 2)};
            Arrays arrays(cloths, Matrix::printed, small_steps, 3, false, {4, 3}, {5, 2});
            arrays.motion.write(arrays.moved.read());  // x̃ and w, as predict_positions leaves them
            arrays.moved.write(poison<cl_float4>(arrays.moved.size()));
            launch::start_small_steps(arrays, {.work_group_size = group});
            const std::vector<cl_float4> moved = arrays.moved.read(), motion = arrays.motion.read(),
                                         total_correction = arrays.total_correction.read();
            std::vector<double> errors, sizes;
            std::size_t i = 0, wrong = 0;
            for (const Cloth& cloth : cloths)
                for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v, ++i) {
                    const std::uint32_t place = arrays.vertex_places[i];
                    for (std::size_t k = 0; k < 3; ++k) {
                        const double step = small_steps.time_step * cloth.velocities[3 * v + k];
                        errors.push_back(static_cast<double>(moved[place].s[k]) -
                                         (cloth.positions[3 * v + k] + step / 4.0));
                        errors.push_back(static_cast<double>(motion[place].s[k]) - step);
                        sizes.push_back(std::abs(cloth.positions[3 * v + k]) + std::abs(step));
                        wrong += total_correction[place].s[k] != 0.0f;
                    }
                    wrong += moved[place].s[3] != static_cast<float>(cloth.inverse_masses[v]);
                    wrong += motion[place].s[3] != static_cast<float>(cloth.inverse_masses[v]);
                    wrong += total_correction[place].s[3] != 0.0f;
                }
            CHECK(norm(errors) <= elementwise_tolerance(3) * norm(sizes));
            CHECK(wrong == 0);
        }
}

TEST_CASE("start_small_steps: nothing where the step is whole or the call has stopped", "[start_small_steps]") {
    const std::vector<Cloth> cloths{make_cloth(strip(100), 1)};
    for (const bool stopped : {false, true}) {
        Arrays arrays(cloths, Matrix::printed, stopped ? small_steps : paper_setting, 2);
        arrays.edit_states([&](apslk_solve_state& state) { state.stopped = stopped; });
        const std::vector<cl_float4> before = arrays.moved.read();
        launch::start_small_steps(arrays, {});
        CHECK(same_bytes(before, arrays.moved.read()));
    }
}
