// SPDX-License-Identifier: MIT
#include "reference/energy_bound.hpp"

#include "unit/reference/stepped_sheet.hpp"

#include <apsl/reference.hpp>

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace apsl;
using namespace apsl::reference;
using namespace apsl::test;

namespace {

using Numbers = std::vector<double>;
using Flags = std::vector<std::uint8_t>;

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
    // There the second vertex, of 0.5 kg, has 1 m/s along its normal, where its plane has 4 m/s: that pulls others
    // along. The fourth is faster than its plane.
    const Numbers contacts{0, 0, 1, 0, 7, 7, 7, 0, 0, 0, 1, 0, 6, 1, 4, 0,
                           0, 0, 1, 0, 7, 7, 7, 0, 0, 0, 1, 0, 2, 1, 1, 0};
    check(drive<double>(buffers({0, 2, 0, 1}, contacts), free), {2, 1, 0}, std::sqrt(2.0), 16.0 * 0.5 * (16.0 - 1.0));
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
        CHECK(driven(gap, 4.0).bodies == Approx(16.0 * 2.0 * (16.0 - 4.0)));
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
    // (square, with friction) of a body that pushes by 3 m/s along z and moves by 2 m/s along its surface.
    const auto added = [](const Vector3<double>& own, double friction) {
        const Numbers numbers{0, 0, 1, 0, 2, 0, 3, friction};
        return added_by_body(Contact<double>(numbers, 0), own, {0, 0, 0});
    };
    CHECK(added({0, 0, 0}, 0.0) == Approx(16.0 * 9.0));  // of a vertex that is slower, and what hangs on it
    CHECK(added({0, 0, 0}, 0.1) == Approx(16.0 * 13.0));
    CHECK(added({50, 0, 0}, 0.0) == Approx(9.0));  // across: squares add
    CHECK(added({50, 0, 0}, 0.1) == Approx(9.0));  // friction slows
    CHECK(added({0, 0, 2}, 0.0) == Approx(16.0 * 5.0));
    CHECK(added({0, 0, -2}, 0.0) == Approx(16.0 * 5.0));
    CHECK(added({0, 0, -4}, 0.0) == 0.0);  // it loses
    CHECK(added({0, 0, 4}, 0.0) == 0.0);   // it is ahead
    CHECK(added_by_body(Contact<double>(Numbers{0, 0, 1, 0, 2, 0, 3, 0}, 0), {2, 0, 3}, {2, 0, 3}) == 0.0);
}

TEST_CASE("energy: a cloth at pins that stand still keeps at most that of the free step, by hand", "[energy]") {
    // 2 kg at 3 m/s beside a pin: Σ m |u|² = 18.
    const Numbers inverse_masses{0, 0.5};
    const EnergyBound<double> bound(buffers(inverse_masses), Free{{0, 0, 0, 3, 0, 0}});
    Numbers slower{0, 0, 0, 0, 2.9, 0}, faster{0, 0, 0, 0, 4, 3}, a_little{0, 0, 0, 0, 3.002, 0};
    const Numbers slower_before = slower, a_little_before = a_little;
    CHECK(bound.apply(slower, Flags{1, 1}) == 1.0);
    CHECK(slower == slower_before);
    CHECK(bound.apply(a_little, Flags{1, 1}) == 1.0);
    CHECK(a_little == a_little_before);
    Numbers within_limits = faster;
    const Numbers faster_before = faster;
    CHECK(bound.apply(within_limits, Flags{0, 0}) == 1.0);
    CHECK(within_limits == faster_before);
    CHECK(bound.apply(faster, Flags{1, 1}) == Approx(9.0 / 25.0));
    CHECK(faster[4] == Approx(2.4));
    CHECK(faster[5] == Approx(1.8));
}

TEST_CASE("energy: a vertex loses what it gained, first where limits are not met, by hand", "[energy]") {
    // Three vertices of 1 kg, Σ m |u|² = 25 + 4 + 0 at the free end.
    const Numbers inverse_masses{0, 1, 1, 1};
    const EnergyBound<double> bound(buffers(inverse_masses), Free{{0, 0, 0, 5, 0, 0, 2, 0, 0, 0, 0, 0}});
    // 16 + 9 + 100: the last is outside its limits, and 4 are left for it. The second gained 5, the first is slower.
    Numbers some{0, 0, 0, 4, 0, 0, 3, 0, 0, 0, 10, 0};
    CHECK(bound.apply(some, Flags{0, 0, 0, 1}) == Approx(29.0 / 125.0));
    CHECK(some[3] == 4.0);
    CHECK(some[6] == 3.0);
    CHECK(some[10] == Approx(2.0));
    // 20.25 + 40 + 1: all that the last gained is not enough. 31.25 more of the 36 that the second did.
    Numbers all{0, 0, 0, 4.5, 0, 0, std::sqrt(40.0), 0, 0, 0, 1, 0};
    CHECK(bound.apply(all, Flags{0, 0, 0, 1}) == Approx(29.0 / 61.25));
    CHECK(all[3] == 4.5);
    CHECK(all[6] == Approx(std::sqrt(8.75)));
    CHECK(all[10] == 0.0);
    // One that is outside its limits and gained nothing loses nothing.
    Numbers slow{0, 0, 0, 4.5, 0, 0, std::sqrt(40.0), 0, 0, 0, 0, 0};
    bound.apply(slow, Flags{1, 1, 0, 0});
    CHECK(slow[3] == 4.5);
    CHECK(slow[6] == Approx(std::sqrt(8.75)));
    // In flight, about a mean of (2.5, 0, 0): 12.5 there, and 50 left.
    const Numbers flying{1, 1};
    Numbers left{7.5, 0, 0, -2.5, 0, 0};
    CHECK(EnergyBound<double>(buffers(flying), Free{{5, 0, 0, 0, 0, 0}}).apply(left, Flags{1, 0}) == Approx(0.25));
    CHECK(left[0] == Approx(5.0));
    CHECK(left[3] == Approx(0.0).margin(1e-12));
}

TEST_CASE("energy: hinges give what they hold, and what drives a cloth what its speed is worth", "[energy]") {
    // 2 kg at 3 m/s, and 16 J in hinges: 18 + 32 = 2 · 5².
    const Numbers inverse_masses{0, 0.5};
    EnergyBound<double> bending(buffers(inverse_masses), Free{{0, 0, 0, 3, 0, 0}});
    bending.add_bending(16.0);
    Numbers faster{0, 0, 0, 0, 10, 0};
    bending.apply(faster, Flags{0, 1});
    CHECK(faster[4] == Approx(5.0));

    // Pins of 0 and 2 m/s: a frame of 1 m/s, and 1 m/s there. A vertex at rest in it may have as much, one at 0.5 m/s
    // there 1.5, and one that is faster 2 at most of theirs.
    const Numbers driven_masses{0, 0, 0.5};
    for (const auto& [free, allowed] : {std::pair(0.0, 1.0), {0.5, 1.5}, {1.0, 2.0}, {1.5, 2.0}, {8.0, 8.0}}) {
        const Numbers ends{0, 0, 0, 2, 0, 0, 1.0 + free, 0, 0};
        Numbers left{0, 0, 0, 2, 0, 0, 18, 0, 0};
        EnergyBound<double>(buffers(driven_masses), Free{ends}).apply(left, Flags{1, 1, 1});
        CHECK(left[3] == 2.0);
        CHECK(left[6] == Approx(1.0 + allowed));
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
