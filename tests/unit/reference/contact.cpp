// SPDX-License-Identifier: MIT
#include "reference/contact.hpp"

#include "unit/reference/stepped_sheet.hpp"

#include <apsl/error.hpp>
#include <apsl/reference.hpp>

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::reference;
using namespace apsl::test;

namespace {

using Vector = Vector3<double>;

constexpr double pi = 3.14159265358979323846;

// One contact for every vertex.
std::vector<double> same_contacts(std::size_t vertices, const std::vector<double>& contact) {
    std::vector<double> all;
    for (std::size_t v = 0; v < vertices; ++v) all.insert(all.end(), contact.begin(), contact.end());
    return all;
}

constexpr Options stepping{.integrates = true, .keeps_contacts = true};
constexpr Options filtering{.keeps_contacts = true};

}  // namespace

TEST_CASE("contact: depth is that under the plane where it stands at the time", "[contact]") {
    // z >= 0.5 at the end, and it rises by 2 m/s.
    const std::vector<double> numbers{0, 0, 1, 0.5, 3, 0, 2, 0};
    const Contact<double> contact(numbers, 0);
    CHECK(contact.depth({0, 0, 0.4}, 0.0) == Approx(0.1));
    CHECK(contact.depth({7, 0, 0.4}, 0.02) == Approx(0.06));
    CHECK(contact.depth({0, 0, 0.4}, 0.1) == 0.0);
    const std::vector<double> none{0, 0, 0, 5, 0, 0, 0, 1};
    CHECK(Contact<double>(none, 0).depth({0, 0, -9}, 0.0) == 0.0);
}

TEST_CASE("contact: a vertex is put on the surface, its speed into it goes, and Coulomb's share of its slip",
          "[contact]") {
    // z >= 0, at rest, friction 0.5. Δt = 0.1 s, in ten parts: 1 m/s into it, 2 m/s along x.
    const std::vector<double> numbers{0, 0, 1, 0, 0, 0, 0, 0.5};
    const Contact<double> contact(numbers, 0);
    MovingVertex<double> at{{5, 0, -0.004}, {0.2, 0, -0.1}, {0.02, 0, -0.01}};
    REQUIRE(at.keep(contact, 0.1, 0.0, 0.1));
    CHECK(at.position.isApprox(Vector(5 - 0.005, 0, 0), 1e-12));  // a quarter of 0.02 m
    CHECK(at.motion.isApprox(Vector(0.15, 0, 0), 1e-12));         // 2 − 0.5 · 1 m/s

    MovingVertex<double> sticks{{5, 0, -0.004}, {0.04, 0, -0.1}, {0.004, 0, -0.01}};
    REQUIRE(sticks.keep(contact, 0.1, 0.0, 0.1));
    CHECK(sticks.position.isApprox(Vector(4.996, 0, 0), 1e-12));
    CHECK(sticks.motion.isZero(1e-12));

    MovingVertex<double> leaves{{5, 0, -0.004}, {0.2, 0, 0.1}, {0.02, 0, 0.01}};
    REQUIRE(leaves.keep(contact, 0.1, 0.0, 0.1));
    CHECK(leaves.position.isApprox(Vector(5, 0, 0), 1e-12));
    CHECK(leaves.motion.isApprox(Vector(0.2, 0, 0.1), 1e-12));

    MovingVertex<double> outside{{5, 0, 0.004}, {0.2, 0, -0.1}, {0.02, 0, -0.01}};
    const MovingVertex<double> before = outside;
    CHECK_FALSE(outside.keep(contact, 0.1, 0.0, 0.1));
    CHECK(outside.position == before.position);
    CHECK(outside.motion == before.motion);
}

TEST_CASE("contact: a body that moves takes along what sticks to it", "[contact]") {
    // z >= 0 at the end, rising by 1 m/s and going along x by 3 m/s. Halfway through a step of 0.1 s it is at −0.05.
    const std::vector<double> numbers{0, 0, 1, 0, 3, 0, 1, 10};
    const Contact<double> contact(numbers, 0);
    MovingVertex<double> at{{0, 0, -0.06}, {0, 0, -0.2}, {0, 0, -0.01}};
    REQUIRE(at.keep(contact, 0.1, 0.05, 0.05));
    CHECK(at.position.isApprox(Vector(0.015, 0, -0.05), 1e-12));
    CHECK(at.motion.isApprox(Vector(0.3, 0, 0.1), 1e-12));
}

TEST_CASE("contact: in a whole step a sheet that falls on a floor lies on it and stays", "[contact][whole_step]") {
    for (const bool limits_stretch : {false, true}) {
        SteppedSheet sheet(9);
        sheet.contacts = same_contacts(sheet.topology->vertex_count(), {0, 1, 0, -0.3, 0, 0, 0, 0.3});
        Options options = stepping;
        options.limits_stretch = limits_stretch;
        const Parameters parameters{.stretch_ceiling = limits_stretch ? 1.1f : 0.0f,
                                    .acceleration = {0.0f, -9.81f, 0.0f}};
        for (int step = 0; step < 60; ++step) {
            const Stats stats = sheet.call(parameters, options);
            CHECK(stats.status == Status::ok);
            CHECK(stats.max_area_change < 1e-3f);
            for (std::size_t v = 1; v < sheet.positions.size(); v += 3) CHECK(sheet.positions[v] >= -0.3 - 1e-12);
        }
        for (std::size_t n = 0; n < sheet.positions.size(); ++n) {
            if (n % 3 == 1) CHECK(sheet.positions[n] == Approx(-0.3));
            CHECK(sheet.velocities[n] == Approx(0.0).margin(1e-9));
        }
    }
}

TEST_CASE("contact: a sheet slides down a slope as Coulomb says, and sticks below his angle", "[contact][whole_step]") {
    const double angle = 30.0 * pi / 180.0;
    for (const double friction : {0.0, 0.2, 0.5, 0.7}) {
        SteppedSheet sheet(5);
        const Vector normal(std::sin(angle), std::cos(angle), 0.0), along(std::cos(angle), -std::sin(angle), 0.0);
        for (std::size_t v = 0; v < sheet.topology->vertex_count(); ++v) {
            Eigen::Map<Vector> x(sheet.positions.data() + 3 * v);
            x = Vector(x.x() * along + x.z() * Vector::UnitZ());
        }
        sheet.contacts =
            same_contacts(sheet.topology->vertex_count(), {normal.x(), normal.y(), normal.z(), 0, 0, 0, 0, friction});
        const std::vector<double> start = sheet.positions;
        Parameters parameters{.acceleration = {0.0f, -9.81f, 0.0f}};
        parameters.target_area_change = 0.0f;
        for (int step = 0; step < 30; ++step) sheet.call(parameters, stepping);
        const double g = static_cast<double>(9.81f);
        const double expected = std::max(g * (std::sin(angle) - friction * std::cos(angle)), 0.0) * 0.5;
        CAPTURE(friction);
        for (std::size_t v = 0; v < sheet.topology->vertex_count(); ++v) {
            const Eigen::Map<const Vector> velocity(sheet.velocities.data() + 3 * v);
            CHECK(velocity.dot(along) == Approx(expected).epsilon(0.005).margin(1e-9));
            CHECK(velocity.dot(normal) == Approx(0.0).margin(1e-9));
        }
    }
}

TEST_CASE("contact: a filter's velocities lead to the outside, whether its corrections stand or not", "[contact]") {
    for (const float target : {0.0f, 100.0f}) {
        SteppedSheet sheet(9);
        for (std::size_t v = 1; v < sheet.velocities.size(); v += 3) sheet.velocities[v] = -1.0;
        for (std::size_t v = 0; v < sheet.velocities.size(); v += 3) sheet.velocities[v] = sheet.positions[v];
        const std::vector<double> before = sheet.velocities;
        sheet.contacts = same_contacts(sheet.topology->vertex_count(), {0, 1, 0, -0.005, 0, 0, 0, 0});
        std::fill(sheet.contacts.begin(), sheet.contacts.begin() + 8, 0.0);  // the first touches nothing
        Parameters parameters;
        parameters.target_area_change = target;
        const Stats stats = sheet.call(parameters, filtering);
        CAPTURE(target, stats.sub_steps);
        CHECK((stats.sub_steps == 0) == (target > 0.0f));
        for (std::size_t n = 1; n < sheet.positions.size(); n += 3) {
            const double end = sheet.positions[n] + static_cast<double>(parameters.time_step) * sheet.velocities[n];
            if (n == 1)
                CHECK(end < -0.01);
            else
                CHECK(end >= -0.005 - 1e-9);
        }
        if (target > 0.0f) {
            CHECK(sheet.velocities[0] == before[0]);
            CHECK(sheet.velocities[1] == before[1]);
            CHECK(sheet.velocities[4] == Approx(-0.3));
        }
    }
}

TEST_CASE("contact: a pinned vertex goes where it goes", "[contact][whole_step]") {
    SteppedSheet sheet(5);
    sheet.inverse_masses[0] = 0.0;
    sheet.velocities[1] = -1.0;
    sheet.contacts = same_contacts(sheet.topology->vertex_count(), {0, 1, 0, 0, 0, 0, 0, 0});
    sheet.call({}, stepping);
    CHECK(sheet.positions[1] == Approx(-1.0 / 60.0));
    CHECK(sheet.velocities[1] == -1.0);
    for (std::size_t n = 4; n < sheet.positions.size(); n += 3) CHECK(sheet.positions[n] >= -1e-12);
}

TEST_CASE("contact: what it needs", "[contact]") {
    const auto message = [](const Parameters& parameters, const Options& options) {
        try {
            validate(options, parameters);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    CHECK(message({.sub_steps = 1}, filtering) == "sub_steps is 1, expected at least 2: keeps_contacts is on");
    CHECK(message({.stepping = Stepping::whole_step}, filtering) ==
          "stepping is whole_step, which does not go with keeps_contacts");
    CHECK(message({}, {.execution = Execution::one_group, .keeps_contacts = true}) ==
          "keeps_contacts is on, which needs execution many_groups");
    CHECK(message({}, {.positions_only = true, .keeps_contacts = true}) ==
          "keeps_contacts is on, which needs velocities: positions_only is on");
    SteppedSheet sheet(3);
    CHECK_THROWS_WITH(sheet.call({}, filtering), "contacts holds 0 numbers, expected 72");
    sheet.contacts = same_contacts(9, {0, 0, 1, 0, 0, 0, 0, 0});
    CHECK_THROWS_WITH(sheet.call({}, {}), "contacts holds 72 numbers, expected 0");
    sheet.contacts[13] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(sheet.call({}, filtering), "contacts of number 13 is nan, expected a finite number");
}
