// SPDX-License-Identifier: MIT
#include "pipeline/energy.hpp"

#include <catch2/catch.hpp>

using namespace apsl;
using namespace apsl::scenes;

namespace {

// A right triangle with legs of 1 m and 2 m, and 1 kg a vertex; the first vertex is pinned.
ClothState triangle() {
    const std::vector<Triangle> triangles{{0, 1, 2}};
    const std::vector<double> rest{0, 0, 0, 1, 0, 0, 0, 2, 0};
    const std::vector<std::uint32_t> pinned{0};
    return make_cloth_state(Topology::build(triangles, 3), rest, 3.0, pinned);
}

}  // namespace

TEST_CASE("energy: kinetic and gravity's of the free vertices, and the springs'") {
    ClothState cloth = triangle();
    for (std::size_t v = 0; v < 3; ++v) {
        cloth.positions[3 * v + 1] -= 2.0;
        cloth.velocities[3 * v] = 3.0;
    }
    cloth.positions[3] += 0.5;
    const std::vector<Spring> springs{{.a = 0, .b = 1, .rest_length = 1.0, .stiffness = 8.0}};
    const Energy sum = energy(cloth, springs, {0.0, -10.0, 0.0});
    CHECK(sum.kinetic == Approx(2 * 0.5 * 1.0 * 9.0));
    CHECK(sum.gravity == Approx(-2 * 1.0 * 10.0 * 2.0));
    CHECK(sum.springs == Approx(0.5 * 8.0 * 0.25));
    CHECK(sum.total() == Approx(sum.kinetic + sum.gravity + sum.springs));
}

TEST_CASE("energy: a cloth at rest where its mesh has it has none") {
    const ClothState cloth = triangle();
    const std::vector<Spring> springs{make_spring(0, 1, cloth.rest_positions, 8.0)};
    CHECK(energy(cloth, springs, {0.0, -10.0, 0.0}).total() == 0.0);
}

TEST_CASE("energy: the greatest speed is that of a free vertex") {
    ClothState cloth = triangle();
    CHECK(greatest_speed(cloth) == 0.0);
    cloth.velocities = {100, 0, 0, 1, 2, 2, 0, 0, 2};
    CHECK(greatest_speed(cloth) == Approx(3.0));
}
