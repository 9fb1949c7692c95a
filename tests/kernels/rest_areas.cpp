// SPDX-License-Identifier: MIT
#include "kernels/launch.hpp"
#include "support/tolerances.hpp"

#include <apsl/reference.hpp>

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;

namespace {

// In the caller's order, next to each other; guard bands and what lies before the first stay.
void check_rest_areas(Arrays& arrays, const Build& build) {
    std::vector<float> poisoned = poison<float>(arrays.rest_areas.size());
    arrays.rest_areas.write(poisoned);
    launch::rest_areas(arrays, build);
    const std::vector<float> got = arrays.rest_areas.read();
    std::vector<double> errors, expected;
    std::size_t n = arrays.array_offset;
    for (const Cloth& cloth : arrays.sources)
        for (const double area : reference::areas<double>(*cloth.topology, cloth.positions)) {
            errors.push_back(static_cast<double>(got[n++]) - area);
            expected.push_back(area);
        }
    CHECK(n == got.size());
    CHECK(norm(errors) <= elementwise_tolerance(8) * norm(expected));
    for (std::size_t i = 0; i < arrays.array_offset; ++i) CHECK(std::isnan(got[i]));
}

}  // namespace

TEST_CASE("rest_areas: awkward sizes in every work-group size", "[rest_areas]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const std::uint32_t size : awkward_sizes(group)) {
            CAPTURE(group, size);
            const std::vector<Cloth> cloths{make_cloth(strip(size), 1), make_cloth(tetrahedron(), 2)};
            Arrays arrays(cloths, Matrix::printed, paper_setting, 3, false, {4, 3});
            check_rest_areas(arrays, {.work_group_size = group});
        }
}
