// SPDX-License-Identifier: MIT
//
// The fuzzer's own parts: cases that repeat, and a shrinker that finds what was planted.
#include "filter/stepped.hpp"
#include "stability/fuzz/make_case.hpp"
#include "stability/fuzz/print_case.hpp"
#include "stability/fuzz/properties.hpp"
#include "stability/fuzz/shrink_case.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <sstream>

using namespace apsl;
using namespace apsl::test;

namespace {

std::string printed(const FuzzCase& c) {
    std::ostringstream text;
    print(c, text);
    return text.str();
}

/// Nothing computed: velocities as given.
class Idle : public FuzzedFilter {
public:
    std::vector<Filtered> call(const std::vector<MovingCloth>& cloths, std::span<const Parameters>) override {
        std::vector<Filtered> results;
        for (const MovingCloth& cloth : cloths) results.push_back({cloth.velocities, {}});
        return results;
    }
    std::string name() const override { return "idle"; }
    bool on_device() const override { return true; }
    double epsilon() const override { return std::numeric_limits<float>::epsilon(); }
};

MovingCloth a_cloth() {
    return moving_cloth(grid(5, 5, 1.0, 1.0, Diagonals::alternating), 1);
}

std::string broken_property(const MovingCloth& cloth, const Filtered& filtered, const Parameters& parameters = {}) {
    const auto violation = violation_of(cloth, {}, parameters, filtered, Idle());
    return violation ? violation->property : "";
}

/// What a call with one sub-step does to a cloth, from the reference: nothing to object to.
Filtered sound(const MovingCloth& cloth, const Parameters& parameters) {
    return filter_with_reference(cloth, {}, parameters);
}

}  // namespace

TEST_CASE("a case follows from seed and number alone") {
    CaseMaker forward(5), direct(5), other(6);
    for (std::uint64_t number = 95; number < 105; ++number) {
        const std::string text = printed(forward.make(number));
        CHECK(text == printed(CaseMaker(5).make(number)));
        CHECK(text != printed(other.make(number)));
    }
    CHECK(printed(direct.make(104)) == printed(forward.make(104)));
}

TEST_CASE("shrinking a planted failure leaves little but what makes it fail") {
    // Fails where a triangle of rest area over 0.004 hangs on a pinned vertex, in a call of ten sub-steps.
    const auto fails = [](const FuzzCase& c) {
        for (const FuzzCall& call : c.calls)
            for (std::size_t n = 0; n < c.cloths.size(); ++n)
                for (std::size_t a = 0; a < c.cloths[n].rest_areas.size(); ++a)
                    for (const std::uint32_t v : c.cloths[n].topology->triangles()[a])
                        if (call.parameters[n].sub_steps == 10 && c.cloths[n].rest_areas[a] > 0.004 &&
                            c.cloths[n].inverse_masses[v] == 0.0)
                            return true;
        return false;
    };
    CaseMaker maker(1);
    int found = 0;
    for (std::uint64_t number = 0; found < 3; ++number) {
        const FuzzCase c = maker.make(number);
        if (!fails(c) || c.calls.size() < 2) continue;
        ++found;
        const FuzzCase small = shrink(c, fails, 2000);
        CAPTURE(printed(small));
        CHECK(fails(small));
        CHECK(small.calls.size() == 1);
        CHECK(small.cloths.size() == 1);
        CHECK(small.cloths[0].rest_areas.size() == 1);
        CHECK(small.cloths[0].inverse_masses.size() == 3);
        CHECK(small.calls[0].parameters[0].regularization == Parameters{}.regularization);
        CHECK(small.offset == 0);
        CHECK(small.cloths[0].velocities == std::vector<double>(9, 0.0));
    }
}

TEST_CASE("each property sees what breaks it") {
    Parameters parameters;
    parameters.regularization = 1.5f;
    parameters.sub_steps = 1;
    MovingCloth cloth = a_cloth();
    const Filtered good = sound(cloth, parameters);
    REQUIRE(good.stats.sub_steps == 1);
    CHECK(broken_property(cloth, good, parameters).empty());

    Filtered bad = good;
    bad.velocities[7] = std::nan("");
    CHECK(broken_property(cloth, bad, parameters) == "a velocity that is not finite was written");
    bad = good;
    bad.velocities[0] += 1e-3;
    CHECK(broken_property(cloth, bad, parameters) == "the velocity of a pinned vertex changed");
    bad = good;
    bad.stats.status = Status::diverged;
    CHECK(broken_property(cloth, bad, parameters) == "diverged, but velocities changed");
    bad = good;
    bad.stats.sub_steps = bad.stats.iterations = 0;
    bad.stats.residual = 0.0f;
    bad.stats.status = Status::ok;
    Parameters met = parameters;
    met.target_area_change = 10.0f;
    CHECK(broken_property(cloth, bad, met) == "no sub-step, but velocities changed");
    CHECK(broken_property(cloth, bad, parameters) == "stopped before the target");
    bad = {cloth.velocities, good.stats};
    bad.stats.status = Status::diverged;
    CHECK(broken_property(cloth, bad, parameters) == "ordinary input diverged");
    bad = good;
    bad.stats.max_area_change += 0.01f;
    CHECK(broken_property(cloth, bad, parameters) == "the greatest area change is not that of the velocities");
    bad = good;
    bad.stats.rms_area_change *= 1.1f;
    CHECK(broken_property(cloth, bad, parameters) == "the RMS area change is not that of the velocities");
    bad = good;
    bad.stats.rms_area_change = std::numeric_limits<float>::infinity();
    CHECK(broken_property(cloth, bad, parameters) == "statistics that are not finite without having diverged");
    bad = good;
    bad.stats.iterations = parameters.max_iterations + 1;
    CHECK(broken_property(cloth, bad, parameters) == "more sub-steps or iterations than allowed");
    bad = good;
    bad.stats.residual = 0.5f;
    CHECK(broken_property(cloth, bad, parameters) == "ok, but a solve missed the tolerance");

    MovingCloth infinite = cloth;
    infinite.positions[30] = std::numeric_limits<double>::infinity();
    CHECK(broken_property(infinite, {cloth.velocities, {}}, parameters) == "input that is not finite did not diverge");
}

TEST_CASE("each property of a whole step sees what breaks it") {
    const Options options{.execution = Execution::many_groups, .integrates = true};
    const Parameters parameters{.regularization = 1.5f, .sub_steps = 5, .tolerance = 1e-4f};
    const MovingCloth cloth = a_cloth();
    const Ended end = step_with_reference(cloth, options, parameters);
    const Filtered good{end.velocities, end.stats, end.positions};
    const auto property = [&](const Filtered& filtered, const Parameters& called) {
        const auto violation = violation_of(cloth, options, called, filtered, Idle());
        return violation ? violation->property : "";
    };
    CHECK(property(good, parameters).empty());

    Filtered bad = good;
    bad.positions[7] = std::nan("");
    CHECK(property(bad, parameters) == "a position that is not finite was written");
    bad = good;
    REQUIRE(cloth.inverse_masses[0] == 0.0);
    bad.positions[0] += 1e-4;
    CHECK(property(bad, parameters) == "a pinned vertex did not go its way");
    bad = good;
    bad.velocities = cloth.velocities;
    bad.stats.status = Status::diverged;
    CHECK(property(bad, parameters) == "diverged, but positions changed");
    bad.stats = {};
    bad.stats.status = Status::off;
    Parameters off = parameters;
    off.enabled = false;
    CHECK(property(bad, off) == "off, but positions changed");
    bad = good;
    for (std::size_t n = 0; n < bad.positions.size(); ++n)
        if (cloth.inverse_masses[n / 3] > 0.0) bad.positions[n] *= 1.1;
    CHECK(property(bad, parameters) == "the greatest area change is not that of the velocities");
}

TEST_CASE("bounds on corrections and momentum see what is beyond them") {
    Parameters parameters;
    parameters.regularization = 1.5f;
    parameters.sub_steps = 1;
    MovingCloth cloth = a_cloth();
    for (double& w : cloth.inverse_masses) w = 100.0;
    const Filtered good = sound(cloth, parameters);
    CHECK(broken_property(cloth, good, parameters).empty());
    // Moved as a whole: areas stay, the centre of mass does not.
    Filtered drifting = good;
    for (std::size_t n = 0; n < drifting.velocities.size(); n += 3) drifting.velocities[n] += 0.1;
    CHECK(broken_property(cloth, drifting, parameters) == "a free cloth's momentum changed");
    for (std::size_t n = 0; n < drifting.velocities.size(); n += 3) drifting.velocities[n] += 1e3;
    CHECK(broken_property(cloth, drifting, parameters) == "corrections greater than the solve can give");
}

TEST_CASE("device and reference: a difference in areas is seen") {
    Parameters parameters;
    parameters.regularization = 1.5f;
    parameters.sub_steps = 1;
    parameters.tolerance = 1e-5f;
    const MovingCloth cloth = a_cloth();
    const Filtered good = sound(cloth, parameters);
    REQUIRE(good.stats.status == Status::ok);
    CHECK_FALSE(disagreement(cloth, {}, parameters, good, good));
    CHECK(disagreement(cloth, {}, parameters, {cloth.velocities, good.stats}, good));
}
