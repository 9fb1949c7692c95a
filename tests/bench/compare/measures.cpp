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
