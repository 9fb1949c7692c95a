// SPDX-License-Identifier: MIT
#include "stability/drift.hpp"
#include "stability/energy.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace apsl::test;
namespace scenes = apsl::scenes;

namespace {

std::vector<Stretch> steady() {
    std::vector<Stretch> stretches(10, Stretch{.kinetic_energy = 0.1,
                                               .total_energy = -2.0,
                                               .max_area_change = 0.01,
                                               .rms_area_change = 0.004,
                                               .resident_bytes = 1000});
    stretches[0].kinetic_energy = 50.0;  // before it has settled
    return stretches;
}

constexpr DriftLimits limits{.energy = 0.01, .area_change = 0.001, .bytes = 100};

}  // namespace

TEST_CASE("drift: none in a steady run, nor in what falls", "[stability]") {
    CHECK(drift(steady(), 2, limits).empty());
    std::vector<Stretch> falling = steady();
    for (std::size_t n = 0; n < falling.size(); ++n) falling[n].total_energy -= static_cast<double>(n);
    CHECK(drift(falling, 2, limits).empty());
}

TEST_CASE("drift: each quantity that grows, or is no number, is named once", "[stability]") {
    const auto check = [](const std::string& name, const auto& change) {
        std::vector<Stretch> stretches = steady();
        for (std::size_t n = 6; n < stretches.size(); ++n) change(stretches[n]);
        const std::vector<std::string> lines = drift(stretches, 2, limits);
        REQUIRE(lines.size() == 1);
        CHECK(lines[0].starts_with(name));
    };
    check("kinetic energy", [](Stretch& s) { s.kinetic_energy += 0.02; });
    check("total energy", [](Stretch& s) { s.total_energy += 0.02; });
    check("total energy", [](Stretch& s) { s.total_energy = std::numeric_limits<double>::quiet_NaN(); });
    check("greatest area change", [](Stretch& s) { s.max_area_change += 0.002; });
    check("RMS area change", [](Stretch& s) { s.rms_area_change += 0.002; });
    check("resident memory", [](Stretch& s) { s.resident_bytes += 101; });
}

TEST_CASE("drift: needs something to compare", "[stability]") {
    CHECK_THROWS_AS(drift(steady(), 9, limits), std::invalid_argument);
}

TEST_CASE("energy of one triangle by hand", "[stability]") {
    scenes::ClothState cloth;
    cloth.positions = {0, 0, 0, 3, 4, 0, 0, 2, 0};
    cloth.velocities = {1, 2, 2, 0, 0, 0, 0, 0, 3};
    cloth.masses = {2.0, 1.0, 4.0};
    CHECK(kinetic_energy(cloth) == Approx(0.5 * 2.0 * 9.0 + 0.5 * 4.0 * 9.0));
    // The spring of rest length 2 is 5 long: ½ · 10 · 3².
    const std::vector<scenes::Spring> springs{{.a = 0, .b = 1, .rest_length = 2.0, .stiffness = 10.0}};
    CHECK(potential_energy(cloth, springs, {0.0, -10.0, 0.0}) == Approx(10.0 * (1.0 * 4.0 + 4.0 * 2.0) + 45.0));
}
