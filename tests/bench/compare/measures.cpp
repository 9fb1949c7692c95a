// SPDX-License-Identifier: MIT
#include "compare/measures.hpp"
#include "measurement/quartiles.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::compare;

namespace {

// A right triangle with legs of 1 m and 2 m, and 1 kg a vertex.
scenes::ClothState triangle() {
    const std::vector<Triangle> triangles{{0, 1, 2}};
    const std::vector<double> rest{0, 0, 0, 1, 0, 0, 0, 2, 0};
    return scenes::make_cloth_state(Topology::build(triangles, 3), rest, 3.0, {});
}

}  // namespace

TEST_CASE("principal stretches of known deformations") {
    scenes::ClothState cloth = triangle();
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
}

TEST_CASE("mean displacement of the free vertices") {
    scenes::ClothState cloth = triangle();
    cloth.inverse_masses[0] = 0.0;
    cloth.positions = {7, 7, 7, 1, -2, 0, 0, 2, 4};
    const std::array<double, 3> moved = mean_displacement(cloth);
    CHECK(moved == std::array<double, 3>{0.0, -1.0, 2.0});
    cloth.inverse_masses = {0.0, 0.0, 0.0};
    CHECK(mean_displacement(cloth) == std::array<double, 3>{});
}

TEST_CASE("deviation is zero from itself and a distance from elsewhere") {
    const std::vector<double> here{0, 0, 0, 1, 1, 1};
    CHECK(deviation(here, here).rms == 0.0);
    CHECK(deviation(here, here).max == 0.0);
    const std::vector<double> there{0, 3, 4, 1, 1, 1};
    CHECK(deviation(here, there).max == Approx(5.0));
    CHECK(deviation(here, there).rms == Approx(5.0 / std::sqrt(2.0)));
}

TEST_CASE("quartiles") {
    using bench::quartiles;
    CHECK(quartiles({4, 1, 3, 2, 5}).median == 3.0);
    CHECK(quartiles({4, 1, 3, 2, 5}).first == 2.0);
    CHECK(quartiles({4, 1, 3, 2, 5}).third == 4.0);
    CHECK(quartiles({1, 2}).median == 1.5);
    CHECK(quartiles({}).median == 0.0);
}
