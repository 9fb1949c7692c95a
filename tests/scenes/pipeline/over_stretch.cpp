// SPDX-License-Identifier: MIT
#include "pipeline/over_stretch.hpp"

#include "sample_cloth.hpp"

#include <catch2/catch.hpp>

using namespace apsl;
using namespace apsl::scenes;

TEST_CASE("over-stretch: a triangle is remembered in the frame in which its longest edge was longest") {
    ClothState cloth = sample_cloth(test::right_triangle());
    OverStretch over_stretch;
    over_stretch.measure(cloth, 0);
    CHECK(over_stretch.triangles().empty());
    const double heights[] = {1.4, 3.0, 2.0};  // of vertex 2, from (0, 1, 0)
    for (int frame = 0; frame < 3; ++frame) {
        cloth.positions[7] = heights[frame];
        over_stretch.measure(cloth, frame);
    }
    REQUIRE(over_stretch.triangles().size() == 1);
    const OverStretchedTriangle worst = over_stretch.triangles()[0];
    CHECK(worst.triangle == 0);
    CHECK(worst.frame == 1);
    CHECK(worst.edge_stretch == Approx(3.0).epsilon(1e-15));
    CHECK(worst.area_change == Approx(2.0).epsilon(1e-15));
}

TEST_CASE("over-stretch: both triangles of an edge count, the longest edge comes first") {
    ClothState cloth = sample_cloth(test::grid(4, 2, 3.0, 1.0, test::Diagonals::uniform));
    for (std::size_t v = 0; v < 8; ++v) {
        double& x = cloth.positions[3 * v];
        x *= x > 0.0 ? 2.0 : 1.6;  // from −1.5 to 1.5
    }
    OverStretch over_stretch;
    over_stretch.measure(cloth, 7);
    const std::vector<OverStretchedTriangle> triangles = over_stretch.triangles();
    REQUIRE(triangles.size() == 6);
    CHECK(triangles.front().edge_stretch == Approx(2.0).epsilon(1e-12));
    CHECK(triangles.back().edge_stretch == Approx(1.6).epsilon(1e-12));
    CHECK(triangles.front().triangle >= 4);
}

TEST_CASE("over-stretch: the cause is told by the pinned vertices") {
    const test::Mesh mesh{.triangles = {{0, 1, 2}, {1, 3, 2}, {1, 4, 3}, {0, 2, 5}},
                          .positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 2, 0, 0, -1, 1, 0}};
    const auto starts = [&](std::uint32_t triangle, const std::vector<std::uint32_t>& pinned, const char* start) {
        const std::string text = over_stretch_cause(sample_cloth(mesh, pinned), triangle, false);
        INFO(text);
        CHECK(text.rfind(start, 0) == 0);
    };
    starts(2, {4}, "hangs by pinned vertex 4, in no other triangle, and carries all the load there: ");
    starts(0, {1}, "hangs by pinned vertex 1, one of 3 triangles that carry the load there: ");
    starts(0, {0, 1}, "holds 2 pinned vertices, which move apart");
    starts(1, {4}, "1 edge from pinned vertex 4, ");
    CHECK(over_stretch_cause(sample_cloth(mesh, {4}), 2, true).ends_with(": more than its stretch ceiling held"));
    starts(3, {4}, "2 edges from pinned vertex 4, ");
    starts(0, {}, "far from any pinned vertex: ");
}
