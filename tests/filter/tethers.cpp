// SPDX-License-Identifier: MIT
#include "filter/stepped.hpp"
#include "support/tolerances.hpp"

#include <apsl/reference.hpp>
#include <apsl/tethers.hpp>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;

namespace {

constexpr Options by_areas{.integrates = true, .tethers_per_vertex = MovingCloth::tethers};
constexpr Options with_all{.limits_stretch = true,
                           .integrates = true,
                           .keeps_contacts = true,
                           .bends = true,
                           .acceleration_per_vertex = true,
                           .tethers_per_vertex = MovingCloth::tethers};

constexpr Parameters falling(int sub_steps) {
    return {.regularization = 1.2f,
            .sub_steps = sub_steps,
            .tolerance = 3e-4f,
            .acceleration = {0.5f, -9.81f, 0.25f},
            .damping = 0.4f};
}

// How much further than tether t reaches its vertex is from its anchor, m; less than 0 within reach, and where it holds
// nothing.
double overreach(const MovingCloth& cloth, const std::vector<double>& positions, std::size_t t) {
    const std::size_t v = t / MovingCloth::tethers, anchor = cloth.tether_anchors[t];
    if (cloth.inverse_masses[v] == 0.0 || cloth.tether_lengths[t] == 0.0 || 3 * anchor >= positions.size()) return -1.0;
    double squared = 0.0;
    for (std::size_t k = 0; k < 3; ++k) squared += std::pow(positions[3 * v + k] - positions[3 * anchor + k], 2);
    return std::sqrt(squared) - cloth.tether_lengths[t];
}

// Its only tether of each vertex is that to its first pin.
MovingCloth with_one_tether(MovingCloth cloth) {
    for (std::size_t t = 1; t < cloth.tether_lengths.size(); t += MovingCloth::tethers) cloth.tether_lengths[t] = 0.0;
    return cloth;
}

MovingCloth unlimited(MovingCloth cloth) {
    std::fill(cloth.rest_areas.begin(), cloth.rest_areas.end(), 0.0);
    return cloth;
}

}  // namespace

TEST_CASE("tethers: what starts within their reach ends there, and what does not is let be", "[filter][tethers]") {
    // Nothing else holds the cloth.
    const MovingCloth cloth = with_one_tether(unlimited(moving_cloth(grid(9, 7, 1.0, 0.7, Diagonals::uniform), 1)));
    for (const int sub_steps : {2, 9}) {
        const Ended got = step_on_device(cloth, by_areas, falling(sub_steps)),
                    without = step_on_device(cloth, {.integrates = true}, falling(sub_steps));
        std::size_t held = 0, outside = 0;
        for (std::size_t t = 0; t < cloth.tether_lengths.size(); ++t) {
            const double before = overreach(cloth, cloth.positions, t), after = overreach(cloth, got.positions, t);
            CAPTURE(sub_steps, t, before, after);
            if (before <= 0.0) CHECK(after < 1e-6);
            if (before > 0.0) CHECK(after < before + 2e-3);  // going round its anchor takes it out a little
            held += before <= 0.0 && overreach(cloth, without.positions, t) > 1e-3;
            outside += before > 0.0;
        }
        CHECK(held > 3);
        CHECK(outside > 3);
    }
}

TEST_CASE("tethers: the device agrees with the reference", "[filter][tethers]") {
    for (const MovingCloth& cloth : small_cloths())
        for (const std::uint32_t work_group_size : compared_group_sizes()) {
            CAPTURE(cloth.rest_areas.size(), work_group_size);
            Options sized = by_areas;
            sized.work_group_size = work_group_size;
            const BothEnds free = check_step_against_reference(unlimited(cloth), sized, falling(4));
            CHECK(difference(free.got.positions, free.want.positions) <=
                  elementwise_tolerance(20.0) * norm(free.want.positions));
            check_step_against_reference(cloth, sized, falling(3));
            check_step_against_reference(cloth, sized, falling(24));
            sized = with_all;
            sized.work_group_size = work_group_size;
            Parameters parameters = falling(6);
            parameters.stretch_ceiling = 1.05f;
            parameters.bending = 1e-3f;
            check_step_against_reference(cloth, sized, parameters);
        }
}

TEST_CASE("tethers: the same bytes twice, in every layout of positions and velocities", "[filter][tethers]") {
    const MovingCloth cloth = moving_cloth(grid(9, 7, 1.0, 0.7, Diagonals::uniform), 1);
    check_step_in_every_layout(cloth, by_areas, falling(4));
}

TEST_CASE("tethers: those of length 0, longer than is moved, or without an anchor change nothing",
          "[filter][tethers]") {
    for (const MovingCloth& cloth : small_cloths()) {
        MovingCloth none = cloth, slack = cloth, nowhere = cloth;
        std::fill(none.tether_lengths.begin(), none.tether_lengths.end(), 0.0);
        std::fill(slack.tether_lengths.begin(), slack.tether_lengths.end(), 1e6);
        std::fill(nowhere.tether_anchors.begin(), nowhere.tether_anchors.end(),
                  static_cast<std::uint32_t>(cloth.inverse_masses.size()));
        const Ended want = step_on_device(none, by_areas, falling(6)),
                    without = step_on_device(cloth, {.integrates = true}, falling(6));
        CAPTURE(cloth.rest_areas.size());
        CHECK(difference(want.positions, without.positions) <= elementwise_tolerance(20.0) * norm(want.positions));
        for (const MovingCloth& other : {slack, nowhere}) {
            const Ended got = step_on_device(other, by_areas, falling(6));
            CHECK(got.positions == want.positions);
            CHECK(got.velocities == want.velocities);
        }
    }
}

TEST_CASE("tethers: an anchor that is not pinned holds nothing", "[filter][tethers]") {
    for (MovingCloth cloth : small_cloths()) {
        for (const std::uint32_t anchor : cloth.tether_anchors)
            if (anchor < cloth.inverse_masses.size()) cloth.inverse_masses[anchor] = 5.0;
        MovingCloth none = cloth;
        std::fill(none.tether_lengths.begin(), none.tether_lengths.end(), 0.0);
        CAPTURE(cloth.rest_areas.size());
        const Ended got = step_on_device(cloth, by_areas, falling(6)),
                    want = step_on_device(none, by_areas, falling(6));
        CHECK(got.positions == want.positions);
        CHECK(got.velocities == want.velocities);
        const Ended reference = step_with_reference(cloth, by_areas, falling(6));
        CHECK(reference.positions == step_with_reference(none, by_areas, falling(6)).positions);
    }
}

TEST_CASE("tethers: two cloths in one limiter are each as in a limiter of their own", "[filter][tethers]") {
    const std::vector<MovingCloth> cloths{moving_cloth(grid(9, 7, 1.0, 0.7, Diagonals::random), 1),
                                          moving_cloth(grid(4, 4, 1.0, 0.7, Diagonals::random), 2)};
    check_step_as_alone(cloths, by_areas, falling(6));
}

TEST_CASE("tethers: another cloth's vertices hold nothing", "[filter][tethers]") {
    std::vector<MovingCloth> cloths{moving_cloth(grid(4, 4, 1.0, 0.7, Diagonals::random), 1),
                                    moving_cloth(grid(4, 4, 1.0, 0.7, Diagonals::random), 2)};
    const Parameters parameters = falling(6);
    const auto second_of = [&] {
        StrainLimiter limiter(device().context, device().id, topologies_of(cloths), by_areas);
        CallerBuffers buffers(cloths, by_areas);
        std::vector<std::uint32_t> anchors = buffers.tether_anchors.read();
        // The second cloth's anchors are numbered as in a limiter of its own: vertices of the first.
        for (std::size_t t = anchors.size() / 2; t < anchors.size(); ++t)
            if (anchors[t] != std::numeric_limits<std::uint32_t>::max()) anchors[t] -= 16;
        buffers.tether_anchors.write(anchors);
        filter(limiter, buffers, {&parameters, 1});
        const std::vector<float> positions = buffers.read_positions();
        return std::vector<float>(positions.begin() + 48, positions.end());
    };
    const std::vector<float> got = second_of();
    std::fill(cloths[1].tether_lengths.begin(), cloths[1].tether_lengths.end(), 0.0);
    CHECK(got == second_of());
}

TEST_CASE("tethers: a curtain hangs within their reach at a third of the products", "[filter][tethers]") {
    // Two corners pinned; neither springs nor bending.
    constexpr std::uint32_t side = 33;
    const auto greatest = [](bool tethered, const Parameters& parameters) {
        MovingCloth cloth = flat_sheet(side, {0, side - 1});
        const std::vector<float> rest(cloth.positions.begin(), cloth.positions.end());
        const Tethers tethers =
            tethers_to_pins(*cloth.topology, rest, std::vector<std::uint32_t>{0, side - 1}, MovingCloth::tethers);
        cloth.tether_anchors = tethers.anchors;
        cloth.tether_lengths.assign(tethers.lengths.begin(), tethers.lengths.end());
        Options options{.limits_stretch = true, .integrates = true};
        if (tethered) options.tethers_per_vertex = MovingCloth::tethers;
        StrainLimiter limiter(device().context, device().id, cloth.topology, options);
        Ended worst{};
        for (int frame = 0; frame < 60; ++frame) {
            const Ended end = step_on_device(limiter, cloth, options, parameters);
            cloth.positions = end.positions;
            cloth.velocities = end.velocities;
            if (frame < 10) continue;
            worst.stats.max_area_change = std::max(worst.stats.max_area_change, end.stats.max_area_change);
            worst.stats.max_stretch = std::max(worst.stats.max_stretch, end.stats.max_stretch);
        }
        return worst.stats;
    };
    Parameters parameters{.regularization = 1.05f,
                          .sub_steps = 15,
                          .stretch_ceiling = 1.1f,
                          .acceleration = {0.0f, -9.81f, 0.0f},
                          .damping = 0.5f};
    const Stats without = greatest(false, parameters);
    parameters.regularization = 1.3f;  // four products a solve in place of eleven
    const Stats with = greatest(true, parameters);
    CAPTURE(without.max_area_change, without.max_stretch, with.max_area_change, with.max_stretch);
    CHECK(with.max_area_change <= 0.02f);
    CHECK(with.max_stretch <= 1.13f);
    CHECK(with.max_area_change <= without.max_area_change);
}

TEST_CASE("tethers: the buffers are asked for with the option, and only then", "[filter][tethers]") {
    const MovingCloth cloth = small_cloths()[0];
    const Owned<cl_command_queue> queue = in_order_queue();
    StrainLimiter tethered(device().context, device().id, cloth.topology, by_areas);
    StrainLimiter plain(device().context, device().id, cloth.topology, {.integrates = true});
    const CallerBuffers buffers({&cloth, 1}, by_areas);
    const Buffers with = buffers.views();
    for (BufferView Buffers::* member : {&Buffers::tether_anchors, &Buffers::tether_lengths}) {
        const char* name = member == &Buffers::tether_anchors ? "buffers.tether_anchors" : "buffers.tether_lengths";
        Buffers without = with, past_the_end = with, alone = with;
        without.*member = {};
        (past_the_end.*member).offset += sizeof(float);
        alone.tether_anchors = alone.tether_lengths = {};
        alone.*member = with.*member;
        CHECK_THROWS_WITH(tethered.enqueue(queue.get(), without, falling(4)), Catch::Contains(name));
        CHECK_THROWS_WITH(tethered.enqueue(queue.get(), past_the_end, falling(4)), Catch::Contains(name));
        CHECK_THROWS_WITH(plain.enqueue(queue.get(), alone, falling(4)),
                          std::string(name) + " is given, but Options::tethers_per_vertex is off");
    }
}
