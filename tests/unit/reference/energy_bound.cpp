// SPDX-License-Identifier: MIT
#include "reference/energy_bound.hpp"

#include "unit/reference/stepped_sheet.hpp"

#include <apsl/reference.hpp>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace apsl;
using namespace apsl::reference;
using namespace apsl::test;

namespace {

using Numbers = std::vector<double>;

constexpr double outside = 0.1, within = 0.025;  // by how much limits are missed

reference::Buffers<double> buffers(const Numbers& inverse_masses, const Numbers& contacts = {}) {
    return {.positions = {},
            .velocities = {},
            .inverse_masses = inverse_masses,
            .rest_areas = {},
            .regularization = {},
            .contacts = contacts};
}

/// A step of 0.5 s that ends with these velocities, where it began in a plane z = 0.
struct Free {
    Numbers velocities, positions = Numbers(velocities.size(), 0.0);

    operator FreeEnd<double>() const { return {positions, velocities, 0.5}; }
};

/// A flat sheet of 0.2 kg, all of it free, that has been crumpled: every vertex is off by up to 1 cm along each axis.
struct Crumpled : SteppedSheet {
    explicit Crumpled(const Vector3<double>& velocity) : SteppedSheet(11) {
        std::mt19937 random(1);
        std::uniform_real_distribution<double> offset(-0.01, 0.01);
        for (double& x : positions) x += offset(random);
        for (std::size_t n = 0; n < velocities.size(); ++n) velocities[n] = velocity[static_cast<Eigen::Index>(n % 3)];
    }

    Vector3<double> mean_velocity() const {
        Vector3<double> momentum = Vector3<double>::Zero();
        double mass = 0.0;
        for (std::size_t i = 0; i < inverse_masses.size(); ++i) {
            momentum += position<double>(velocities, i) / inverse_masses[i];
            mass += 1.0 / inverse_masses[i];
        }
        return momentum / mass;
    }
    /// m/s, of any vertex about the mean.
    double greatest_own_speed() const {
        double greatest = 0.0;
        for (std::size_t i = 0; i < inverse_masses.size(); ++i)
            greatest = std::max(greatest, (position<double>(velocities, i) - mean_velocity()).norm());
        return greatest;
    }
};

}  // namespace

TEST_CASE("energy: what drives a cloth, and in which frame", "[energy]") {
    const auto check = [](const Drive& got, const Vector3<double>& velocity, double pins, double bodies) {
        CHECK((got.velocity - velocity).norm() <= 1e-14);
        CHECK(got.pins == Approx(pins).margin(1e-14));
        CHECK(got.bodies == Approx(bodies).margin(1e-13));
    };
    // Pins of (1, 0, 0) and (3, 2, 0).
    const Free free{{1, 0, 0, 2, 1, 1, 3, 2, 0, 2, 1, 2}};
    check(drive<double>(buffers({0, 1, 0, 1}), free), {2, 1, 0}, std::sqrt(2.0), 0.0);
    // There the second vertex, of 0.5 kg, has 1 m/s along its normal, where its plane has 4 m/s. That pulls along what
    // hangs on it, up to the cloth's 1.5 kg. The fourth is faster than its plane.
    const Numbers contacts{0, 0, 1, 0, 7, 7, 7, 0, 0, 0, 1, 0, 6, 1, 4, 0,
                           0, 0, 1, 0, 7, 7, 7, 0, 0, 0, 1, 0, 2, 1, 1, 0};
    check(drive<double>(buffers({0, 2, 0, 1}, contacts), free), {2, 1, 0}, std::sqrt(2.0), 3.0 * 0.5 * (16.0 - 1.0));
    // Masses of 1 and 4 kg, without pins: with nothing that they may touch, or before a wall that stands still.
    const Free flying{{5, 0, 0, 0, 10, 0}};
    check(drive<double>(buffers({1, 0.25}), flying), {1, 8, 0}, 0.0, 0.0);
    check(drive<double>(buffers({1, 0.25}, Numbers(16, 0.0)), flying), {1, 8, 0}, 0.0, 0.0);
    check(drive<double>(buffers({1, 0.25}, {0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1}), flying), {0, 0, 0}, 0.0,
          0.0);
    check(drive<double>(buffers({}), Free{}), {0, 0, 0}, 0.0, 0.0);
}

TEST_CASE("energy: what a vertex cannot reach within the step drives nothing", "[energy]") {
    // A floor that rises by 4 m/s, 3 m below the free end of a vertex of 2 m/s that falls: they close by 3 m in 0.5 s.
    const auto driven = [](double gap, double upwards) {
        return drive<double>(buffers({0.5}, {0, 0, 1, -gap, 0, 0, upwards, 0}), Free{{0, 0, -2}});
    };
    for (const double gap : {-1.0, 0.0, 2.999}) {
        CHECK(driven(gap, 4.0).bodies == Approx(2.0 * (16.0 - 4.0)));
        CHECK_FALSE(driven(gap, 4.0).flies);
    }
    CHECK(driven(3.001, 4.0).bodies == 0.0);
    CHECK(driven(3.001, 4.0).flies);
    CHECK(driven(3.001, 4.0).velocity == Vector3<double>(0, 0, -2));
    // One that stands still is within 1 m of it.
    CHECK_FALSE(driven(0.999, 0.0).flies);
    CHECK(driven(1.001, 0.0).flies);
}

TEST_CASE("energy: what a body adds to a vertex, by hand", "[energy]") {
    // Of a body that pushes by 3 m/s along z and moves by 2 m/s along its surface.
    const auto contact = [](double friction) { return Numbers{0, 0, 1, 0, 2, 0, 3, friction}; };
    const auto added = [&](const Vector3<double>& own, double friction) {
        const Numbers numbers = contact(friction);
        return added_by_body(Contact<double>(numbers, 0), own, {0, 0, 0});
    };
    CHECK(added({0, 0, 0}, 0.0) == Approx(9.0));
    CHECK(added({0, 0, 0}, 1.0) == Approx(9.0 + 4.0));   // closing at 3 m/s, friction gives all of 2 m/s
    CHECK(added({0, 0, 0}, 0.1) == Approx(9.0 + 0.09));  // and here 0.3 m/s of it
    CHECK(added({1, 0, 2}, 0.5) == Approx(5.0 + 1.5 * 1.5 - 1.0));
    CHECK(added({0, 0, 3}, 0.5) == 0.0);           // it does not press
    CHECK(added({50, 0, 0}, 0.0) == Approx(9.0));  // across: squares add
    CHECK(added({50, 0, 0}, 0.1) == Approx(9.0));  // friction slows
    CHECK(added({0, 0, 2}, 0.0) == Approx(5.0));
    CHECK(added({0, 0, -2}, 0.0) == Approx(5.0));
    CHECK(added({0, 0, -4}, 0.0) == 0.0);  // it loses
    CHECK(added({0, 0, 4}, 0.0) == 0.0);   // it is ahead
    const Numbers numbers = contact(0.0);
    const Contact<double> moving(numbers, 0);
    CHECK(added_by_body(moving, {2, 0, 3}, {2, 0, 3}) == 0.0);
    CHECK(pulls_along(moving, {0, 0, 0}, {0, 0, 0}));
    CHECK_FALSE(pulls_along(moving, {50, 0, 0}, {0, 0, 0}));
    CHECK_FALSE(pulls_along(moving, {0, 0, 0}, {2, 0, 3}));
    // What is pulled along counts up to the mass of the cloth, and 16 times the vertices' own.
    CHECK(AddedByBodies{2.0, 3.0, 0.5}.of_cloth(1.0) == Approx(2.0 + 3.0 * 2.0));
    CHECK(AddedByBodies{2.0, 3.0, 0.5}.of_cloth(100.0) == Approx(2.0 + 3.0 * 16.0));
    CHECK(AddedByBodies{2.0, 0.0, 0.0}.of_cloth(100.0) == 2.0);
}

TEST_CASE("energy: a cloth at pins that stand still keeps at most that of the free step, by hand", "[energy]") {
    // 2 kg at 3 m/s beside a pin: Σ m |u|² = 18.
    const Numbers inverse_masses{0, 0.5};
    const EnergyBound<double> bound(buffers(inverse_masses), Free{{0, 0, 0, 3, 0, 0}});
    // Where limits are missed by half as much as would be outside, a fifth more passes.
    Numbers slower{0, 0, 0, 0, 2.9, 0}, faster{0, 0, 0, 3, 4, 0}, a_little{0, 0, 0, 0, 3.002, 0},
        a_fifth{0, 0, 0, 3.28, 0, 0};
    for (Numbers* kept : {&slower, &a_little, &a_fifth}) {
        const Numbers before = *kept;
        CHECK(bound.apply(*kept, kept == &a_fifth ? within : outside) == 1.0);
        CHECK(*kept == before);
    }
    CHECK(bound.apply(a_fifth, outside) == Approx(9.0 / (3.28 * 3.28)));
    Numbers at_its_limits = faster;
    CHECK(bound.apply(at_its_limits, 0.0) == 1.0);
    CHECK(at_its_limits == faster);
    CHECK(bound.apply(faster, outside) == Approx(9.0 / 25.0));
    CHECK(faster == Numbers{0, 0, 0, 3, 0, 0});
}

TEST_CASE("energy: a vertex that gained is led back to its free velocity, by hand", "[energy]") {
    // Three vertices of 1 kg, Σ m |u|² = 25 + 4 + 0 at the free end.
    const Numbers inverse_masses{0, 1, 1, 1};
    const EnergyBound<double> bound(buffers(inverse_masses), Free{{0, 0, 0, 5, 0, 0, 2, 0, 0, 0, 0, 0}});
    // 16 + 5 + 100, of which 101 are gains and 92 too many. The first is slower than it was free.
    Numbers some{0, 0, 0, 4, 0, 0, 2, 1, 0, 0, 10, 0};
    CHECK(bound.apply(some, outside) == Approx(29.0 / 121.0));
    CHECK(some[3] == 4.0);
    CHECK(some[6] == 2.0);
    CHECK(some[7] == Approx(9.0 / 101.0));
    CHECK(some[10] == Approx(90.0 / 101.0));
    // What acceleration gave on a way that the cloth did not go is not there: 13 are left for 16 and 36. All gains are
    // not enough then, and all of it is slowed.
    EnergyBound<double> held(buffers(inverse_masses), Free{{0, 0, 0, 5, 0, 0, 2, 0, 0, 0, 0, 0}});
    held.follow(
        Numbers{0, 0, 0, 3, 0, 0, 2, 0, 0, 0, 0, 0}, 0.5, [](std::size_t) { return 0.0; },
        [](std::size_t n) { return n == 3 ? 2.0 : 0.0; });
    Numbers all{0, 0, 0, 4, 0, 0, 0, 6, 0, 0, 0, 0};
    CHECK(held.apply(all, outside) == Approx(13.0 / 52.0));
    CHECK(all[3] == Approx(4.0 * std::sqrt(13.0 / 20.0)));
    CHECK(all[6] == Approx(2.0 * std::sqrt(13.0 / 20.0)));
    CHECK(all[7] == Approx(0.0).margin(1e-12));
    // In flight, about a mean of (2.5, 0, 0): 12.5 there, and 50 left.
    const Numbers flying{1, 1};
    Numbers left{7.5, 0, 0, -2.5, 0, 0};
    CHECK(EnergyBound<double>(buffers(flying), Free{{5, 0, 0, 0, 0, 0}}).apply(left, outside) == Approx(0.25));
    CHECK(left[0] == Approx(5.0));
    CHECK(left[3] == Approx(0.0).margin(1e-12));
}

TEST_CASE("energy: acceleration gives what it does on the way that the cloth went, by hand", "[energy]") {
    // 2 kg that start at 3 m/s and gain 2 m/s in 0.5 s, over the 2 m of the free step: Σ m |u|² = 2 · 25. Over Δx it is
    // 2 · (3² + 2 · 4 m/s² · Δx).
    const Numbers inverse_masses{0, 0.5};
    for (const double change : {2.0, 1.0, 3.0, 0.0, -1.0, -2.0}) {
        EnergyBound<double> bound(buffers(inverse_masses), Free{{0, 0, 0, 5, 0, 0}});
        bound.follow(
            Numbers{7, 7, 7, 3, 0, 0}, 0.5, [&](std::size_t n) { return n == 3 ? change : 0.0; },
            [](std::size_t n) { return n == 3 ? 2.0 : 0.0; });
        Numbers left{0, 0, 0, 100, 0, 0};
        CHECK(bound.apply(left, outside) == Approx(std::max(9.0 + 8.0 * change, 0.0) / 1e4).margin(1e-12));
    }
}

TEST_CASE("energy: hinges give what they hold, and what drives a cloth what its speed is worth", "[energy]") {
    // 2 kg at 3 m/s, and 16 J in hinges: 18 + 32 = 2 · 5².
    const Numbers inverse_masses{0, 0.5};
    EnergyBound<double> bending(buffers(inverse_masses), Free{{0, 0, 0, 3, 0, 0}});
    bending.add_bending(16.0);
    Numbers faster{0, 0, 0, 10, 0, 0};
    CHECK(bending.apply(faster, outside) == Approx(0.25));
    CHECK(faster[3] == Approx(3.0 + 7.0 * (1.0 - 75.0 / 91.0)));

    // Pins of 0 and 2 m/s: a frame of 1 m/s, and 1 m/s there. A vertex at rest in it may have as much, one at 0.5 m/s
    // there 1.5, and one that is faster 2 at most of theirs.
    const Numbers driven_masses{0, 0, 0.5};
    for (const auto& [free, allowed] : {std::pair(0.0, 1.0), {0.5, 1.5}, {1.0, 2.0}, {1.5, 2.0}, {8.0, 8.0}}) {
        const Numbers ends{0, 0, 0, 2, 0, 0, 1.0 + free, 0, 0};
        Numbers left{0, 0, 0, 2, 0, 0, 18, 0, 0};
        const double share = EnergyBound<double>(buffers(driven_masses), Free{ends}).apply(left, outside);
        CHECK(share == Approx(allowed * allowed / (17.0 * 17.0)));
        CHECK(left[3] == 2.0);
        CHECK(left[6] <= 1.0 + allowed + 1e-12);
        CHECK(left[6] >= 1.0 + free);
    }
}

TEST_CASE("energy: corrections of positions throw nothing about, and a free cloth keeps its momentum",
          "[energy][whole_step]") {
    for (const Vector3<double>& velocity : {Vector3<double>(0, 0, 0), Vector3<double>(3, -20, 1)}) {
        Crumpled cloth(velocity);
        CAPTURE(velocity.transpose());
        double area_change = 1.0;
        for (int call = 0; call < 4; ++call) {
            area_change = static_cast<double>(
                cloth.call({.stretch_ceiling = 1.01f}, {.limits_stretch = true, .integrates = true}).max_area_change);
            // Only the first call finds it outside its limits. Every vertex would have 0.5 to 2 m/s of its own.
            CHECK((cloth.mean_velocity() - velocity).norm() <= (call == 0 ? 1e-9 : 1e-5));
            CHECK(cloth.greatest_own_speed() <= (call == 0 ? 1e-6 : 0.1));
        }
        CHECK(area_change < 0.01);
    }
}
