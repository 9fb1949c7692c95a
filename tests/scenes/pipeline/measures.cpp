// SPDX-License-Identifier: MIT
#include "pipeline/measures.hpp"

#include "pipeline/advance.hpp"
#include "sample_cloth.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace apsl;
using namespace apsl::scenes;

TEST_CASE("measures: a triangle drawn out to twice its height has area change 1, before it has moved") {
    ClothState cloth = sample_cloth(test::right_triangle());
    cloth.velocities[7] = 2.0;  // vertex 2 from (0, 1, 0) to (0, 2, 0) in half a second
    CHECK(area_changes(cloth)[0] == 0.0);
    CHECK(predicted_area_changes(cloth, 0.5)[0] == Approx(1.0).epsilon(1e-15));
    advance_positions(cloth, 0.5);
    CHECK(area_changes(cloth)[0] == Approx(1.0).epsilon(1e-15));
    const EdgeStretch stretch = edge_stretch(cloth);
    CHECK(stretch.max == Approx(2.0).epsilon(1e-15));
    CHECK(stretch.min == Approx(1.0).epsilon(1e-15));
}

TEST_CASE("measures: a cloth scaled to half its size has every area change 3/4 and every stretch 1/2") {
    const test::Mesh mesh = test::grid(6, 4, 1.0, 1.0, test::Diagonals::random);
    ClothState cloth = sample_cloth(mesh);
    cloth.positions = moved(mesh.positions, -0.5, mesh.positions);
    const AreaChange change = summarize(cloth, area_changes(cloth));
    CHECK(change.max == Approx(0.75).epsilon(1e-13));
    CHECK(change.rms == Approx(0.75).epsilon(1e-13));
    CHECK(edge_stretch(cloth).min == Approx(0.5).epsilon(1e-13));
    CHECK(edge_stretch(cloth).max == Approx(0.5).epsilon(1e-13));
}

TEST_CASE("measures: what pins make of the triangles between them") {
    ClothState cloth = sample_cloth(test::grid(2, 2, 1.0, 1.0, test::Diagonals::uniform));
    const Triangle pinned = cloth.topology->triangles()[0];
    for (std::size_t v = 0; v < 4; ++v) cloth.positions[3 * v] *= 1.5;
    CHECK(pinned_area_change(cloth) == 0.0);
    cloth.inverse_masses[pinned[0]] = cloth.inverse_masses[pinned[1]] = 0.0;
    CHECK(pinned_area_change(cloth) == 0.0);
    cloth.inverse_masses[pinned[2]] = 0.0;
    CHECK(pinned_area_change(cloth) == Approx(0.5).epsilon(1e-13));
}

TEST_CASE("measures: greatest and root mean square by hand, triangles without rest area left out") {
    ClothState cloth = sample_cloth(test::grid(2, 2, 1.0, 1.0, test::Diagonals::uniform));
    AreaChange change = summarize(cloth, {0.3, 0.4});
    CHECK(change.max == 0.4);
    CHECK(change.rms == Approx(std::sqrt(0.125)).epsilon(1e-15));
    cloth.rest_areas[1] = 0.0;
    change = summarize(cloth, {0.3, 0.4});
    CHECK(change.max == 0.3);
    CHECK(change.rms == Approx(0.3).epsilon(1e-15));
    CHECK(area_changes(cloth)[1] == 0.0);
}

TEST_CASE("measures: a number that is not finite shows in the summary") {
    ClothState cloth = sample_cloth(test::grid(2, 2, 1.0, 1.0, test::Diagonals::uniform));
    cloth.positions[0] = std::numeric_limits<double>::quiet_NaN();
    CHECK(std::isnan(summarize(cloth, area_changes(cloth)).max));
    CHECK(std::isnan(summarize(cloth, area_changes(cloth)).rms));
}

TEST_CASE("principal stretches of known deformations") {
    const std::vector<Triangle> triangles{{0, 1, 2}};  // right, with legs of 1 m and 2 m
    const std::vector<double> rest{0, 0, 0, 1, 0, 0, 0, 2, 0};
    ClothState cloth = make_cloth_state(Topology::build(triangles, 3), rest, 3.0, {});
    const auto principal_stretch = [](const ClothState& state) { return range_of(principal_stretches(state)); };
    SECTION("rest, turned and moved") {
        cloth.positions = {5, 5, 5, 5, 5, 6, 5, 7, 5};
        CHECK(principal_stretch(cloth).min == Approx(1.0));
        CHECK(principal_stretch(cloth).max == Approx(1.0));
    }
    SECTION("along the axes") {
        cloth.positions = {0, 0, 0, 3, 0, 0, 0, 1, 0};
        CHECK(principal_stretch(cloth).min == Approx(0.5));
        CHECK(principal_stretch(cloth).max == Approx(3.0));
    }
    SECTION("simple shear by 1: the golden ratio and its inverse, with edges that show neither") {
        cloth.positions = {0, 0, 0, 1, 0, 0, 2, 2, 0};
        const double golden = 0.5 * (1.0 + std::sqrt(5.0));
        CHECK(principal_stretch(cloth).min == Approx(1.0 / golden));
        CHECK(principal_stretch(cloth).max == Approx(golden));
    }
    SECTION("collapsed to a line") {
        cloth.positions = {0, 0, 0, 1, 0, 0, 2, 0, 0};
        CHECK(principal_stretch(cloth).min == Approx(0.0).margin(1e-7));
    }
    SECTION("a triangle without a rest area counts as not stretched") {
        cloth.rest_areas = {0.0};
        cloth.positions = {0, 0, 0, 3, 0, 0, 0, 1, 0};
        CHECK(principal_stretch(cloth).max == 1.0);
    }
}
