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

TEST_CASE("rest_areas, rest_shapes: nothing where two corners coincide, wherever they are",
          "[rest_areas][rest_shapes]") {
    Mesh mesh;
    mesh.positions = {0.1, 0.7, -0.3, 1.3, 0.9, 0.37, 0.21, -1.1, 0.77};
    mesh.triangles = {{0, 1, 2}, {3, 1, 2}, {0, 4, 1}, {0, 1, 5}};
    for (const std::size_t v : {1, 1, 0})  // 3 and 4 lie at 1, 5 at 0
        mesh.positions.insert(mesh.positions.end(),
                              {mesh.positions[3 * v], mesh.positions[3 * v + 1], mesh.positions[3 * v + 2]});
    for (const std::uint32_t group : work_group_sizes()) {
        CAPTURE(group);
        std::vector<Cloth> cloths{make_cloth(mesh, 1)};
        cloths[0].positions = mesh.positions;
        Arrays arrays(cloths, Matrix::consistent, paper_setting, 1);
        launch::rest_areas(arrays, {.work_group_size = group});
        launch::rest_shapes(arrays, {.work_group_size = group, .chebyshev = true, .limits_stretch = true});
        const std::vector<float> areas = arrays.rest_areas.read(), shapes = arrays.rest_shapes.read();
        CHECK(areas[0] > 0.5f);
        for (std::size_t a = 1; a < 4; ++a) {
            CAPTURE(a);
            CHECK(areas[a] == 0.0f);
            for (std::size_t k = 4 * a; k < 4 * a + 4; ++k) CHECK(shapes[k] == 0.0f);
        }
    }
}
