// SPDX-License-Identifier: MIT
#include "methods/tethered_distances.hpp"

#include "bench/methods/sample_cloths.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <utility>

using namespace apsl;
using namespace apsl::test;
using methods::Cloth;
using methods::TetheredDistances;
using methods::TetherSettings;

namespace {

using Vectors = std::vector<Eigen::Vector3f>;

const TetherSettings one_step{
    .steps = 1, .tether_length = 0.0, .bending = 0.0, .damping = 0.0, .gravity = Eigen::Vector3d::Zero()};

struct Moved {
    Vectors positions, velocities;
};

Moved advanced(const Cloth& cloth, const TetherSettings& settings, Vectors positions, Vectors velocities,
               int time_steps = 1) {
    TetheredDistances method(cloth, settings);
    for (int i = 0; i < time_steps; ++i) method.advance(positions, velocities);
    return {std::move(positions), std::move(velocities)};
}

Vectors still(const Cloth& cloth) {
    return Vectors(cloth.rest_positions.size(), Eigen::Vector3f::Zero());
}

// A strip of `squares` squares of 5 cm along z, its first two vertices pinned, 0.01 s a time step.
Cloth strip(std::uint32_t squares) {
    Cloth cloth = cloth_of(grid(2, squares + 1, 0.05, 0.05 * squares, Diagonals::alternating), {0, 1});
    cloth.time_step = 0.01;
    return cloth;
}

// m, how far the strip's end is below its pins after it has come to rest.
double depth_of(const Cloth& cloth, TetherSettings settings) {
    settings.damping = 5.0;
    const Vectors end = advanced(cloth, settings, rest_of(cloth), still(cloth), 500).positions;
    return end.front().y() - end.back().y();
}

}  // namespace

TEST_CASE("tethers: an edge takes its error away in one small step, by the inverse masses of its ends", "[methods]") {
    Cloth cloth = cloth_of(right_triangle(), {2});
    cloth.inverse_masses[1] = 3.0;
    // As for pbd_edges: once the edge 0–1 is done, the other two are at rest.
    const Vectors start{{0.0f, 0.0f, 0.0f}, {3.0f, 0.0f, 0.0f}, {0.25f, 1.0f, 0.0f}};
    const Moved moved = advanced(cloth, one_step, start, still(cloth));
    CHECK((moved.positions[0] - Eigen::Vector3f(0.25f, 0.0f, 0.0f)).norm() < 1e-6f);
    CHECK((moved.positions[1] - Eigen::Vector3f(2.25f, 0.0f, 0.0f)).norm() < 1e-6f);
    CHECK((moved.velocities[1] - Eigen::Vector3f(-7.5f, 0.0f, 0.0f)).norm() < 1e-5f);  // over 0.1 s
}

TEST_CASE("tethers: a bending constraint takes its part of the error of the vertices opposite an edge", "[methods]") {
    // Two right triangles on the edge 0–1, folded up by a right angle; the edge and one vertex are pinned.
    const Mesh wings{{{0, 1, 2}, {1, 0, 3}}, {0, 0, 0, 0, 0, 1, 1, 0, 0, -1, 0, 0}};
    Cloth cloth = cloth_of(wings, {0, 1, 2});
    TetherSettings settings = one_step;
    settings.bending = 0.5;
    const Vectors folded{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    // Half of 2 − √2 along (−1, 1, 0) / √2, and then the edges 0–3 and 1–3 one after the other: the first is too long
    // by |p| − 1 and points at p.
    const Eigen::Vector3d bent =
        Eigen::Vector3d(0, 1, 0) + 0.5 * (2.0 - std::sqrt(2.0)) * Eigen::Vector3d(-1, 1, 0) / std::sqrt(2.0);
    Eigen::Vector3d expected = bent.normalized();
    const Eigen::Vector3d from_one = expected - Eigen::Vector3d(0, 0, 1);
    expected = Eigen::Vector3d(0, 0, 1) + std::sqrt(2.0) * from_one.normalized();
    const Moved moved = advanced(cloth, settings, folded, still(cloth));
    CHECK((moved.positions[3].cast<double>() - expected).norm() < 1e-6);
    CHECK(expected.x() < -0.1);  // it did bend
}

TEST_CASE("tethers: a vertex beyond its tether comes back to its end, one within does not feel it", "[methods]") {
    const Cloth cloth = cloth_of(grid(3, 2, 2.0, 1.0, Diagonals::uniform), {0});
    TetherSettings tethered = one_step;
    tethered.tether_length = 1.0;
    Vectors outward = still(cloth);
    outward[2] = {10.0f, 0.0f, 0.0f};  // by 1 m in the step, along the first row
    const Moved held = advanced(cloth, tethered, rest_of(cloth), outward);
    for (std::size_t v = 0; v < held.positions.size(); ++v)
        CHECK((held.positions[v] - rest_of(cloth)[v]).norm() < 1e-6f);
    CHECK(greatest_edge_ratio(cloth, advanced(cloth, one_step, rest_of(cloth), outward).positions) > 1.1f);
    Vectors inward = still(cloth);
    inward[2] = {-10.0f, 0.0f, 0.0f};
    const Vectors within = advanced(cloth, tethered, rest_of(cloth), inward).positions;
    const Vectors free = advanced(cloth, one_step, rest_of(cloth), inward).positions;
    for (std::size_t v = 0; v < free.size(); ++v) CHECK((within[v] - free[v]).norm() < 1e-6f);
    tethered.tether_length = 1.5;  // to 3 m, which is where it goes
    CHECK((advanced(cloth, tethered, rest_of(cloth), outward).positions[2] -
           advanced(cloth, one_step, rest_of(cloth), outward).positions[2])
              .norm() < 1e-5f);
}

TEST_CASE("tethers: a hanging strip is as long as at rest, without tethers it sags", "[methods]") {
    const Cloth cloth = strip(60);
    CHECK(depth_of(cloth, {.steps = 2}) == Approx(3.0).epsilon(0.01));
    CHECK(depth_of(cloth, {.steps = 2, .tether_length = 0.0}) > 3.1);
    CHECK(depth_of(cloth, {.steps = 100, .tether_length = 0.0}) == Approx(3.0).epsilon(0.01));
}

TEST_CASE("tethers: momentum is kept without pins, whatever the masses", "[methods]") {
    Cloth cloth = cloth_of(grid(7, 6, 1.0, 1.0, Diagonals::random));
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v)
        cloth.inverse_masses[v] = 1.0 + static_cast<double>(v % 5);
    Vectors velocities = still(cloth);
    for (std::size_t v = 0; v < velocities.size(); ++v)
        velocities[v] = {std::sin(static_cast<float>(7 * v)), std::cos(static_cast<float>(3 * v)), 0.5f};
    TetherSettings settings{.steps = 8, .damping = 0.0, .gravity = Eigen::Vector3d::Zero()};
    const Eigen::Vector3d before = first_moment(cloth, velocities);
    const Moved moved = advanced(cloth, settings, stretched(cloth, 1.2f), velocities, 3);
    CHECK((first_moment(cloth, moved.velocities) - before).norm() < 1e-4 * before.norm());
    CHECK_FALSE(same_bytes(moved.velocities, velocities));
}

TEST_CASE("tethers: free fall and damping are those of the small steps", "[methods]") {
    const Cloth cloth = cloth_of(right_triangle());
    const Moved moved =
        advanced(cloth, {.steps = 4, .damping = 2.0, .gravity = {0, -10, 0}}, rest_of(cloth), still(cloth));
    double velocity = 0.0;
    double fallen = 0.0;
    for (int step = 0; step < 4; ++step) {
        velocity = velocity * std::exp(-2.0 * 0.025) - 0.025 * 10.0;
        fallen += 0.025 * velocity;
    }
    for (std::size_t v = 0; v < 3; ++v) {
        CHECK(moved.velocities[v].y() == Approx(velocity).epsilon(1e-4));
        CHECK(moved.positions[v].y() - rest_of(cloth)[v].y() == Approx(fallen).epsilon(1e-4));
    }
}

TEST_CASE("tethers: pins stand, or go by their velocity, and draw the cloth with them", "[methods]") {
    const Cloth cloth = hanging_grid(6);
    const Moved hanging = advanced(cloth, {.steps = 10}, rest_of(cloth), still(cloth), 5);
    CHECK(hanging.positions[0] == rest_of(cloth)[0]);
    CHECK(hanging.positions[5] == rest_of(cloth)[5]);
    CHECK(hanging.velocities[5] == Eigen::Vector3f::Zero());
    Vectors velocities = still(cloth);
    velocities[0] = velocities[5] = {0.0f, 1.0f, 0.0f};
    const Moved drawn = advanced(cloth, {.steps = 10}, rest_of(cloth), velocities, 20);
    CHECK(drawn.positions[0].y() == Approx(2.0).epsilon(1e-4));
    CHECK(drawn.positions[35].y() > 0.9f);
    CHECK(greatest_edge_ratio(cloth, drawn.positions) < 1.1f);
}

TEST_CASE("tethers: collapsed cloths and numbers that are not finite do not crash", "[methods]") {
    const Cloth cloth = hanging_grid(5);
    const Vectors point(cloth.rest_positions.size(), Eigen::Vector3f(1.0f, 2.0f, 3.0f));
    for (const Eigen::Vector3f& x : advanced(cloth, {}, point, still(cloth)).positions) CHECK(x.allFinite());
    Vectors broken = rest_of(cloth);
    broken[7].y() = std::numeric_limits<float>::quiet_NaN();
    CHECK_FALSE(advanced(cloth, {}, broken, still(cloth)).positions[7].allFinite());
}

TEST_CASE("tethers: settings out of range are named", "[methods]") {
    const Cloth cloth = hanging_grid(3);
    CHECK_THROWS_WITH(TetheredDistances(cloth, {.steps = 0}), Catch::Contains("steps is 0"));
    CHECK_THROWS_WITH(TetheredDistances(cloth, {.tether_length = -1.0}), Catch::Contains("tether_length is -1"));
    CHECK_THROWS_WITH(TetheredDistances(cloth, {.bending = 2.0}), Catch::Contains("bending is 2"));
    CHECK_THROWS_WITH(TetheredDistances(cloth, {.damping = std::nan("")}), Catch::Contains("damping is nan"));
}
