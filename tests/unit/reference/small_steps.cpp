// SPDX-License-Identifier: MIT
#include "resolved_parameters.hpp"
#include "unit/reference/run_filter.hpp"
#include "unit/reference/sample_cloths.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::reference;

namespace {

// A triangle with two pinned vertices and a third that moves along its altitude: one dimension, solvable by hand.
// Height h, base 1, rest height 1; the solve moves it by −(h − 1) / α exactly.
struct Altitude {
    std::shared_ptr<const Topology> topology = Topology::build(std::vector<Triangle>{{0, 1, 2}}, 3);
    std::vector<double> positions{0, 0, 0, 1, 0, 0, 0.5, 1, 0};
    std::vector<double> inverse_masses{0, 0, 2};
    std::vector<double> rest_areas{0.5};

    std::pair<double, Stats> speed_after(double speed, const Parameters& parameters) const {
        std::vector<double> velocities{0, 0, 0, 0, 0, 0, 0, speed, 0};
        StrainLimiter limiter(topology);
        limiter.enqueue({positions, velocities, inverse_masses, rest_areas, {}}, parameters);
        return {velocities[7], limiter.read_stats()};
    }
};

constexpr float alpha = 2.0f;
Parameters with_small_steps(int sub_steps) {
    return {.time_step = 0.5f,
            .regularization = alpha,
            .sub_steps = sub_steps,
            .tolerance = 1e-6f,
            .stepping = Stepping::small_steps};
}

}  // namespace

TEST_CASE("small steps from 20 sub-steps up, and never with fewer than two") {
    const auto small_steps = [](int sub_steps, Stepping stepping) {
        return ResolvedParameters(Parameters{.sub_steps = sub_steps, .stepping = stepping}).small_steps;
    };
    CHECK(small_steps(19, Stepping::automatic) == 0);
    CHECK(small_steps(20, Stepping::automatic) == 19);
    CHECK(small_steps(50, Stepping::whole_step) == 0);
    CHECK(small_steps(2, Stepping::small_steps) == 1);
    CHECK(small_steps(1, Stepping::small_steps) == 0);
    CHECK(ResolvedParameters(Parameters{.tolerance = 0.1f, .stepping = Stepping::whole_step}).solve_tolerance == 0.1f);
    CHECK(ResolvedParameters(Parameters{.tolerance = 0.1f}).solve_tolerance == Approx(0.3f));
    CHECK(ResolvedParameters(Parameters{.tolerance = 0.9f}).solve_tolerance == Approx(0.9f));
}

TEST_CASE("small steps: along an altitude, by hand") {
    // Three sub-steps, so two parts. Δt v = 0.4: at h = 1.2 the first solve takes 0.1 off, the velocity loses 2 × 0.1,
    // the second part adds (0.4 − 0.2) / 2 = 0.1: h = 1.2, again 0.1 off: 1.1. The last takes 0.05 off: h = 1.05.
    const Altitude triangle;
    const auto [speed, stats] = triangle.speed_after(0.8, with_small_steps(3));
    CHECK(stats.sub_steps == 3);
    CHECK(stats.initial_max_area_change == Approx(0.4f));
    CHECK(stats.max_area_change == Approx(0.05f));
    CHECK(speed == Approx(0.05 / 0.5));
}

TEST_CASE("small steps: the target is looked at before the first and before its last sub-step") {
    const Altitude triangle;
    Parameters parameters = with_small_steps(3);
    parameters.target_area_change = 0.4001f;
    CHECK(triangle.speed_after(0.8, parameters).second.sub_steps == 0);
    CHECK(triangle.speed_after(0.8, parameters).first == 0.8);
    parameters.target_area_change = 0.15f;  // met in the end by 0.1, and not on the way
    CHECK(triangle.speed_after(0.8, parameters).second.sub_steps == 2);
    parameters.target_area_change = 0.09f;
    CHECK(triangle.speed_after(0.8, parameters).second.sub_steps == 3);
}

TEST_CASE("small steps: the error of the start is led back over the parts, by hand") {
    // Height 1.4, at rest; α = 2, two parts. The first solve aims at half of the error, 1.2: it takes (0.4 − 0.2) / 2 =
    // 0.1 off, the velocity becomes −0.2, the second part moves by −0.1: h = 1.2. The second aims at 1: 0.1 off, 1.1.
    // The last takes 0.05 off: h = 1.05. In all −0.35 over Δt = 0.5.
    Altitude triangle;
    triangle.positions[7] = 1.4;
    const auto [speed, stats] = triangle.speed_after(0.0, with_small_steps(3));
    CHECK(speed == Approx(-0.7));
    CHECK(stats.max_area_change == Approx(0.05f));
    CHECK(start_error_left(0, 2) == 0.5f);
    CHECK(start_error_left(1, 2) == 0.0f);
    CHECK(start_error_left(2, 2) == 0.0f);
}

TEST_CASE("small steps: no triangle is asked for more than four times its area") {
    // Height 0.1, two parts, α = 2. Half of the error −0.9 stays for now, so the first solve would ask for −0.45 and is
    // held to −3 × 0.1: it moves by 0.15. The velocity carries that to 0.4; there −0.6 is within 3 × 0.4: 0.3 more,
    // 0.7. The last takes half of what is left: 0.85.
    Altitude triangle;
    triangle.positions[7] = 0.1;
    const auto [speed, stats] = triangle.speed_after(0.0, with_small_steps(3));
    CHECK(stats.max_area_change == Approx(0.15f));
    CHECK(speed == Approx(1.5));
}

TEST_CASE("small steps: an error of the start is mended at the speed of a whole step") {
    // A cap of 2 cm pushed up into a sheet at rest. Small steps once gave it 54 times the energy of the whole step.
    constexpr std::uint32_t side = 17;
    test::SampleCloth cloth = test::grid_cloth(side, side, test::Diagonals::uniform);
    double middle[3] = {0.0, 0.0, 0.0};
    for (std::size_t n = 0; n < cloth.positions.size(); ++n) middle[n % 3] += cloth.positions[n] / (side * side);
    for (std::size_t v = 0; v < side * side; ++v) {
        double* const x = &cloth.positions[3 * v];  // in the plane of x and z
        const double r = std::hypot(x[0] - middle[0], x[2] - middle[2]);
        if (r < 0.1) x[1] += std::sqrt(0.09 - r * r) - 0.28;
    }
    const auto energy = [&](Stepping stepping) {
        const std::vector<double> at_rest(cloth.positions.size(), 0.0);
        const auto [velocities, stats] =
            test::run_filter<double>(cloth, at_rest, {.stepping = stepping}, Matrix::consistent);
        double sum = 0.0;
        for (std::size_t n = 0; n < velocities.size(); ++n)
            sum += 0.5 * velocities[n] * velocities[n] / cloth.inverse_masses[n / 3];
        CHECK(stats.max_area_change < stats.initial_max_area_change);
        return sum;
    };
    const double whole = energy(Stepping::whole_step), small = energy(Stepping::small_steps);
    CHECK(whole > 0.0);
    CHECK(small <= 2.0 * whole);
}
