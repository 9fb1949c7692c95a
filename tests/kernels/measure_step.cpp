// SPDX-License-Identifier: MIT
#include "kernels/launch.hpp"
#include "reference/geometry.hpp"
#include "support/tolerances.hpp"

#include <apsl/reference.hpp>

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

using namespace apsl;
using namespace apsl::test;

namespace {

constexpr Parameters walk{.sub_steps = 5, .stepping = Stepping::small_steps};

// The start of the step, apart from its end.
void write_starts(Arrays& arrays, const std::vector<double>& starts) {
    std::vector<cl_float4> motion = arrays.predicted.read();
    for (std::size_t i = 0; i < motion.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            motion[arrays.vertex_places[i]].s[k] = static_cast<float>(starts[3 * i + k]);
    arrays.motion.write(motion);
}

double not_finite(const Arrays& arrays, std::size_t cloth) {
    const std::vector<double> groups = arrays.partials_of(cloth, APSL_PARTIAL_NOT_FINITE);
    return std::accumulate(groups.begin(), groups.end(), 0.0);
}

}  // namespace

TEST_CASE("measure_step: what areas are off by at the start, awkward sizes in every work-group size",
          "[measure_step]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const std::uint32_t size : awkward_sizes(group)) {
            CAPTURE(group, size);
            std::vector<Cloth> cloths{make_cloth(strip(size), 1), make_cloth(tetrahedron(), 2)};
            cloths[0].rest_areas[size / 2] = 0.0;  // not limited
            Arrays arrays(cloths, Matrix::consistent, walk, 3);
            const std::vector<double> starts = random_numbers(3 * arrays.predicted.size(), -1.0, 1.0, 7);
            write_starts(arrays, starts);
            launch::measure_area_change(arrays, {.work_group_size = group});
            const std::vector<float> at_the_end = arrays.partials.read();
            arrays.partials.write(poison<float>(arrays.partials.size()));
            launch::measure_step(arrays, {.work_group_size = group});

            // The sums are those of the end of the step.
            for (std::size_t c = 0; c < cloths.size(); ++c)
                for (const int kind : {APSL_PARTIAL_MAX_CHANGE, APSL_PARTIAL_SQUARED_CHANGE, APSL_PARTIAL_CAPPED_CHANGE,
                                       APSL_PARTIAL_MEASURED, APSL_PARTIAL_NOT_FINITE})
                    for (std::uint32_t g = 0; g < arrays.groups; ++g)
                        CHECK(arrays.partials_of(c, kind)[g] ==
                              static_cast<double>(at_the_end[(c * APSL_PARTIAL_KINDS + kind) * arrays.groups + g]));

            const std::vector<float> errors = arrays.start_errors.read();
            for (const float padding : arrays.padding_of(errors)) CHECK(padding == 0.0f);
            std::ptrdiff_t first = 0;
            for (std::size_t c = 0; c < cloths.size(); ++c) {
                const auto coordinates = static_cast<std::ptrdiff_t>(3 * cloths[c].topology->vertex_count());
                const std::vector<double> own(starts.begin() + first, starts.begin() + first + coordinates);
                first += coordinates;
                std::vector<double> want = reference::areas<double>(*cloths[c].topology, own), sizes = want;
                for (std::size_t a = 0; a < want.size(); ++a) {
                    sizes[a] += cloths[c].rest_areas[a];
                    want[a] = cloths[c].rest_areas[a] > 0.0 ? want[a] - cloths[c].rest_areas[a] : 0.0;
                }
                CHECK(difference(arrays.of_cloth(errors, c), want) <= elementwise_tolerance(10) * norm(sizes));
            }
        }
}

TEST_CASE("measure_step: counts triangles that are not finite at either end of the step", "[measure_step]") {
    for (const double bad : {std::nan(""), static_cast<double>(INFINITY), 3e38})
        for (const std::uint32_t group : {1u, 64u}) {
            CAPTURE(bad, group);
            const std::vector<Cloth> cloths{make_cloth(strip(40), 1)};
            for (const bool at_start : {false, true}) {
                Arrays arrays(cloths, Matrix::consistent, walk, 2);
                arrays.motion.write(arrays.predicted.read());
                DeviceArray<cl_float4>& vertices = at_start ? arrays.motion : arrays.predicted;
                std::vector<cl_float4> x = vertices.read();
                x[arrays.vertex_places[20]].s[1] = static_cast<float>(bad);  // at three triangles of the strip
                vertices.write(x);
                launch::measure_step(arrays, {.work_group_size = group});
                CHECK(not_finite(arrays, 0) == 3.0);
            }
        }
}

TEST_CASE("measure_step: writes no start error where the step is whole", "[measure_step]") {
    const std::vector<Cloth> cloths{make_cloth(strip(100), 1)};
    Arrays arrays(cloths, Matrix::consistent, paper_setting, 2);
    launch::measure_step(arrays, {});
    CHECK(same_bytes(arrays.start_errors.read(), arrays.poisoned_triangles()));
    CHECK(not_finite(arrays, 0) == 0.0);
}
