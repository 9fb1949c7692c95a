// SPDX-License-Identifier: MIT
#include "reference/effective_masses.hpp"

#include "unit/reference/run_filter.hpp"
#include "unit/reference/sample_cloths.hpp"

#include <apsl/reference.hpp>

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;

namespace {

std::vector<double> varied_pressures(std::size_t count) {
    std::vector<double> lambda(count);
    for (std::size_t a = 0; a < count; ++a) lambda[a] = 1e-5 * (1.0 + std::sin(1.3 * static_cast<double>(a)));
    return lambda;
}

}  // namespace

TEST_CASE("geometric stiffness: the second difference of areas as a vertex leaves its plane", "[reference]") {
    SampleCloth cloth = grid_cloth(7, 6, Diagonals::alternating);
    const std::vector<double> lambda = varied_pressures(cloth.rest_areas.size());
    const auto flat = cloth.geometry();
    const reference::Vector3<double> normal = flat[0].normal;
    constexpr double h = 1e-5;
    for (std::size_t i = 0; i < cloth.topology->vertex_count(); ++i) {
        const auto areas_at = [&](double offset) {
            std::vector<double> positions = cloth.positions;
            for (int k = 0; k < 3; ++k) positions[3 * i + static_cast<std::size_t>(k)] += offset * normal[k];
            return reference::areas<double>(*cloth.topology, positions);
        };
        const auto above = areas_at(h), below = areas_at(-h);
        double expected = 0.0;
        for (std::size_t a = 0; a < lambda.size(); ++a)
            expected += 2.0 * lambda[a] * (above[a] - 2.0 * flat[a].area + below[a]) / (h * h);
        CAPTURE(i);
        CHECK(reference::geometric_stiffness<double>(*cloth.topology, flat, lambda, i) ==
              Approx(expected).epsilon(1e-3));
    }
}

TEST_CASE("geometric stiffness: compression and triangles without area add nothing", "[reference]") {
    SampleCloth cloth = grid_cloth(3, 3, Diagonals::uniform);
    std::vector<double> lambda = varied_pressures(cloth.rest_areas.size());
    for (double& value : lambda) value = -value;
    CHECK(reference::geometric_stiffness<double>(*cloth.topology, cloth.geometry(), lambda, 4) == 0.0);
    for (double& coordinate : cloth.positions) coordinate = 0.0;
    for (double& value : lambda) value = -value;
    CHECK(reference::geometric_stiffness<double>(*cloth.topology, cloth.geometry(), lambda, 4) == 0.0);
}

TEST_CASE("effective mass: twice the stiffness, between the own mass and the greatest", "[reference]") {
    CHECK(reference::effective_mass(2.0, 0.0, 10.0) == 2.0);
    CHECK(reference::effective_mass(2.0, 1.0, 10.0) == 2.0);
    CHECK(reference::effective_mass(2.0, 3.0, 10.0) == 6.0);
    CHECK(reference::effective_mass(2.0, 30.0, 10.0) == 10.0);
    CHECK(reference::effective_mass(20.0, 30.0, 10.0) == 20.0);  // heavier than the greatest: its own
    // Masses of 1, 4 and 9 kg, and a pin: ten times the geometric mean.
    const std::vector<double> inverse{1.0, 0.25, 1.0 / 9.0, 0.0};
    CHECK(reference::greatest_effective_mass<double>(inverse) == Approx(10.0 * std::cbrt(36.0)));
    CHECK(reference::greatest_effective_mass<double>(std::vector<double>{0.0, 0.0}) == 0.0);
}

TEST_CASE("effective masses: raised at once, let go by a tenth a sub-step, pins and heavy vertices as given",
          "[reference]") {
    const std::vector<double> inverse{1.0, 0.0, 0.25};
    reference::EffectiveMasses<double> masses;
    masses.start(inverse);
    masses.greatest = 100.0;
    masses.tension = {5.0, 5.0, 1.0};
    CHECK(masses.share_taken(0, inverse[0]) == Approx(0.2));  // 1 kg against 5
    CHECK(masses.share_taken(1, inverse[1]) == 1.0);
    CHECK(masses.share_taken(2, inverse[2]) == 1.0);
    masses.raise(inverse);
    CHECK(masses.inverse[0] == Approx(0.1));
    CHECK(masses.inverse[1] == 0.0);
    CHECK(masses.inverse[2] == 0.25);
    masses.tension = {0.0, 0.0, 0.0};
    masses.raise(inverse);
    CHECK(masses.inverse[0] == Approx(1.0 / 9.0));
    for (int n = 0; n < 30; ++n) masses.raise(inverse);
    CHECK(masses.inverse[0] == 1.0);  // to the bit
}

TEST_CASE("effective masses: well-shaped cloth raises none, light vertices under load are raised", "[reference]") {
    SampleCloth cloth = grid_cloth(9, 9, Diagonals::alternating);
    for (std::size_t v = 0; v < 9; ++v) cloth.inverse_masses[v] = 0.0;
    std::vector<double> falling(cloth.positions.size(), 0.0);
    for (std::size_t v = 9; v < cloth.inverse_masses.size(); ++v) falling[3 * v + 1] = -3.0;
    const Parameters parameters{};
    const auto [unused, regular] = run_filter<double>(cloth, falling, parameters, Matrix::consistent);
    CHECK(regular.status == Status::ok);
    CHECK(regular.raised_vertices == 0);
    CHECK(regular.greatest_mass_ratio == 1.0f);
    cloth.inverse_masses[13] *= 1000.0;  // in the row that the pins hold
    const auto [velocities, light] = run_filter<double>(cloth, falling, parameters, Matrix::consistent);
    CHECK(light.status == Status::ok);
    CHECK(light.raised_vertices >= 1);
    CHECK(light.greatest_mass_ratio > 2.0f);
    CHECK(light.max_area_change < light.initial_max_area_change);
}
