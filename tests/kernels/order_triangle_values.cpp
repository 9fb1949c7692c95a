// SPDX-License-Identifier: MIT
#include "kernels/launch.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;

namespace {

// Poisons the ordered arrays, runs the kernel, and expects exactly the caller's numbers at their places; a padding of
// zeros, as the host makes it, stays zeros.
void check_ordered(Arrays& arrays, const Build& build) {
    const std::vector<float> rest_areas = arrays.ordered_rest.read();
    const std::vector<float> regularization = arrays.ordered_scaling.read();
    const std::vector<float> poisoned = arrays.poisoned_triangles();
    std::vector<float> all_runs = rest_areas;
    std::copy(poisoned.begin(), poisoned.end(), all_runs.begin());
    arrays.ordered_rest.write(all_runs);
    arrays.ordered_scaling.write(poisoned);
    launch::order_triangle_values(arrays, build);
    CHECK(same_bytes(rest_areas, arrays.ordered_rest.read()));
    CHECK(same_bytes(build.alpha_per_triangle ? regularization : poisoned, arrays.ordered_scaling.read()));
}

}  // namespace

TEST_CASE("order_triangle_values: awkward sizes in every work-group size, with and without alpha per triangle",
          "[order_triangle_values]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const std::uint32_t size : awkward_sizes(group))
            for (const bool per_triangle : {false, true}) {
                CAPTURE(group, size, per_triangle);
                const std::vector<Cloth> cloths{make_cloth(strip(size), 1), make_cloth(tetrahedron(), 2)};
                Arrays arrays(cloths, Matrix::printed, paper_setting, 3, per_triangle, {3, size % 2});
                check_ordered(arrays, {.work_group_size = group, .alpha_per_triangle = per_triangle});
            }
}

TEST_CASE("order_triangle_values: alpha below 1 and NaN become 1", "[order_triangle_values]") {
    std::vector<Cloth> cloths{make_cloth(strip(5), 1)};
    cloths[0].regularization = {0.5, std::nan(""), -1.0, 1.0, 3.0};
    Arrays arrays(cloths, Matrix::printed, paper_setting, 1, false);
    launch::order_triangle_values(arrays, {.alpha_per_triangle = true});
    const std::vector<double> ordered = arrays.of_cloth(arrays.ordered_scaling.read(), 0);
    CHECK(ordered == std::vector<double>{1.0, 1.0, 1.0, 1.0, 3.0});
}
