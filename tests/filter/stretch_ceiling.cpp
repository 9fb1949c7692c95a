// SPDX-License-Identifier: MIT
#include "reference/stretch_rows.hpp"

#include "filter/filtered.hpp"
#include "support/tolerances.hpp"

#include <apsl/reference.hpp>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

using namespace apsl;
using namespace apsl::test;

namespace {

constexpr Options with_ceiling{.execution = Execution::many_groups, .limits_stretch = true};

/// Greatest principal stretch at the end of a step with these velocities, in double precision, of all triangles.
double max_stretch(const MovingCloth& cloth, const std::vector<double>& velocities, double time_step) {
    std::vector<double> end = cloth.positions;
    for (std::size_t n = 0; n < end.size(); ++n) end[n] += time_step * velocities[n];
    double greatest = 0.0;
    for (std::size_t a = 0; a < cloth.rest_areas.size(); ++a)
        greatest =
            std::max(greatest, reference::principal_stretch<double>(reference::rest_shape<double>(cloth.rest_shapes, a),
                                                                    cloth.topology->triangles()[a], end)
                                   .value);
    return greatest;
}

/// A square of n × n vertices, 1 m wide and hung by two corners, that falls with nothing but gravity and the limiter.
struct Hanging {
    explicit Hanging(std::uint32_t n) : cloth(flat_sheet(n, {0, n - 1})) {}

    void accelerate(double time_step) {
        for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v)
            if (cloth.inverse_masses[v] > 0.0) cloth.velocities[3 * v + 1] -= 9.81 * time_step;
        for (double& v : cloth.velocities) v = static_cast<float>(v);
    }

    void move(double time_step) {
        for (std::size_t n = 0; n < cloth.positions.size(); ++n)
            cloth.positions[n] = static_cast<float>(cloth.positions[n] + time_step * cloth.velocities[n]);
    }

    MovingCloth cloth;
};

}  // namespace

TEST_CASE("stretch ceiling: the device agrees with the reference", "[filter][stretch_ceiling]") {
    const std::vector<MovingCloth> all = small_cloths();
    const Parameters settings[] = {
        {.regularization = 1.3f, .sub_steps = 1, .tolerance = 1e-4f, .stretch_ceiling = 1.05f},
        {.regularization = 1.2f,
         .sub_steps = 3,
         .tolerance = 3e-4f,
         .stretch_ceiling = 1.02f,
         .stepping = Stepping::whole_step},
        {.regularization = 1.2f, .sub_steps = 6, .tolerance = 3e-4f, .stretch_ceiling = 1.1f},
        {.regularization = 1.2f, .sub_steps = 2, .most_sub_steps = 9, .tolerance = 3e-4f, .stretch_ceiling = 1.02f}};
    for (const std::uint32_t work_group_size : compared_group_sizes())
        for (const bool per_triangle : {false, true}) {
            Options options = with_ceiling;
            options.work_group_size = work_group_size;
            options.stretch_ceiling_per_triangle = per_triangle;
            for (const Parameters& parameters : settings) {
                // Anew: what a call asks of the next would be remembered.
                StrainLimiter limiter(device().context, device().id, topologies_of(all), options);
                const CallerBuffers buffers(all, options);
                const std::vector<Stats> stats = filter(limiter, buffers, {&parameters, 1});
                const std::vector<float> velocities = buffers.read_velocities();
                auto begin = velocities.begin();
                for (std::size_t c = 0; c < all.size(); ++c) {
                    CAPTURE(work_group_size, per_triangle, c, parameters.sub_steps);
                    const auto end = begin + static_cast<std::ptrdiff_t>(all[c].velocities.size());
                    const Filtered got{{begin, end}, stats[c]};
                    check_against_reference(got, all[c], options, parameters);
                    const Stats want = filter_with_reference(all[c], options, parameters).stats;
                    // Where tension is far beyond what sub-steps resolve, rounding grows.
                    const double sensitive = want.greatest_mass_ratio > 20.0f ? 2e-2 : 2e-3;
                    const auto near = [=](float value) { return Approx(value).epsilon(sensitive).margin(2e-4); };
                    CHECK(stats[c].sub_steps == want.sub_steps);
                    CHECK(stats[c].iterations == want.iterations);
                    CHECK(stats[c].max_stretch == near(want.max_stretch));
                    CHECK(stats[c].max_stretch_excess == near(want.max_stretch_excess));
                    CHECK(stats[c].rms_stretch_excess == near(want.rms_stretch_excess));
                    CHECK(stats[c].initial_max_stretch_excess == near(want.initial_max_stretch_excess));
                    CHECK(stats[c].initial_rms_stretch_excess == near(want.initial_rms_stretch_excess));
                    CHECK(stats[c].stretch_rows <= all[c].rest_areas.size());
                    if (!per_triangle)
                        CHECK(static_cast<double>(stats[c].max_stretch) ==
                              Approx(max_stretch(all[c], got.velocities, static_cast<double>(parameters.time_step)))
                                  .epsilon(1e-4));
                    begin = end;
                }
            }
        }
}

TEST_CASE("stretch ceiling: a curtain that falls by gravity alone keeps it, and its areas",
          "[filter][stretch_ceiling]") {
    constexpr Parameters parameters{.stretch_ceiling = 1.1f};
    constexpr double time_step = 1.0 / 60.0;
    Hanging curtain(33);
    StrainLimiter limiter(device().context, device().id, curtain.cloth.topology, with_ceiling);
    double area_change = 0.0, stretch = 0.0;
    for (int frame = 0; frame < 60; ++frame) {
        curtain.accelerate(time_step);
        const CallerBuffers buffers({&curtain.cloth, 1}, with_ceiling);
        const Stats stats = filter(limiter, buffers, {&parameters, 1})[0];
        CAPTURE(frame);
        CHECK(stats.status == Status::ok);
        const std::vector<float> velocities = buffers.read_velocities();
        curtain.cloth.velocities.assign(velocities.begin(), velocities.end());
        area_change = std::max(area_change, static_cast<double>(stats.max_area_change));
        stretch = std::max(stretch, static_cast<double>(stats.max_stretch));
        CHECK(max_stretch(curtain.cloth, curtain.cloth.velocities, time_step) ==
              Approx(stats.max_stretch).epsilon(1e-3));
        curtain.move(time_step);
    }
    CHECK(area_change < 0.02);
    CHECK(stretch < 1.12);
    CHECK(stretch > 1.09);  // it is drawn to the ceiling
}

TEST_CASE("stretch ceiling: where pins leave no room it gives way, and areas hold", "[filter][stretch_ceiling]") {
    constexpr Parameters parameters{.stretch_ceiling = 1.1f};
    constexpr double time_step = 1.0 / 60.0, speed = 0.3;  // m/s: parted by 30 % in a second
    Hanging sheet(17);
    for (std::size_t v = 0; v < sheet.cloth.inverse_masses.size(); ++v)
        sheet.cloth.inverse_masses[v] = std::abs(sheet.cloth.positions[3 * v]) > 0.499
                                            ? 0.0
                                            : static_cast<double>(static_cast<float>(17 * 17 / 0.2));
    StrainLimiter limiter(device().context, device().id, sheet.cloth.topology, with_ceiling);
    float area_change = 0.0f, mass_ratio = 1.0f, excess = 0.0f;
    double fastest = 0.0;
    for (int frame = 0; frame < 90; ++frame) {
        sheet.accelerate(time_step);
        for (std::size_t v = 0; v < sheet.cloth.inverse_masses.size(); ++v)
            if (sheet.cloth.inverse_masses[v] == 0.0)
                sheet.cloth.velocities[3 * v] = frame < 60 && sheet.cloth.positions[3 * v] > 0.0
                                                    ? static_cast<double>(static_cast<float>(speed))
                                                    : 0.0;
        const CallerBuffers buffers({&sheet.cloth, 1}, with_ceiling);
        const Stats stats = filter(limiter, buffers, {&parameters, 1})[0];
        const std::vector<float> velocities = buffers.read_velocities();
        sheet.cloth.velocities.assign(velocities.begin(), velocities.end());
        sheet.move(time_step);
        area_change = std::max(area_change, stats.max_area_change);
        mass_ratio = std::max(mass_ratio, stats.greatest_mass_ratio);
        excess = stats.max_stretch_excess;
        if (frame >= 60)
            for (const double v : sheet.cloth.velocities) fastest = std::max(fastest, std::abs(v));
    }
    CHECK(area_change < 0.1f);
    CHECK(mass_ratio < 1000.0f);
    CHECK(excess > 0.1f);  // named
    CHECK(excess < 1.0f);
    CHECK(fastest < 4.0);
}

TEST_CASE("stretch ceiling: cloths with ceilings of their own get the bytes they would get alone",
          "[filter][stretch_ceiling]") {
    const std::vector<MovingCloth> all = small_cloths();
    const std::vector<Parameters> parameters{{.sub_steps = 5, .stretch_ceiling = 1.05f},
                                             {.sub_steps = 4, .stretch_ceiling = 0.0f},
                                             {.regularization = 1.2f, .sub_steps = 7, .stretch_ceiling = 1.2f},
                                             {.enabled = false},
                                             {.sub_steps = 2, .most_sub_steps = 8, .stretch_ceiling = 1.01f},
                                             {.sub_steps = 3, .stretch_ceiling = 3.0f},
                                             {.sub_steps = 0, .stretch_ceiling = 1.1f}};
    Options options = with_ceiling;
    options.work_group_size = 1;
    for (int again = 0; again < 2; ++again) {
        StrainLimiter limiter(device().context, device().id, topologies_of(all), options);
        const CallerBuffers buffers(all, options);
        const std::vector<Stats> stats = filter(limiter, buffers, parameters);
        const std::vector<float> velocities = buffers.read_velocities();
        auto begin = velocities.begin();
        for (std::size_t c = 0; c < all.size(); ++c) {
            CAPTURE(again, c);
            const auto end = begin + static_cast<std::ptrdiff_t>(all[c].velocities.size());
            const Filtered alone = filter_on_device(all[c], options, parameters[c]);
            CHECK(std::equal(begin, end, alone.velocities.begin(), alone.velocities.end()));
            CHECK(stats[c].status == alone.stats.status);
            CHECK(stats[c].stretch_rows == alone.stats.stretch_rows);
            begin = end;
        }
        CHECK(stats[1].max_stretch == 0.0f);  // no ceiling, nothing measured
        CHECK(stats[6].stretch_rows == 0);    // no sub-step
    }
}

TEST_CASE("stretch ceiling: a cloth at rest keeps every bit of its velocities", "[filter][stretch_ceiling]") {
    Hanging curtain(9);
    for (double& v : curtain.cloth.velocities) v = 0.0;
    const Parameters parameters{.stretch_ceiling = 1.01f};
    const Filtered got = filter_on_device(curtain.cloth, with_ceiling, parameters);
    CHECK(greatest(got.velocities) < 1e-3);
    CHECK(got.stats.stretch_rows == 0);
    CHECK(got.stats.max_stretch_excess == 0.0f);
}

TEST_CASE("stretch ceiling: rest shapes from rest positions, or turned about in their planes, are the same",
          "[filter][stretch_ceiling]") {
    MovingCloth cloth = moving_cloth(grid(17, 13, 1.0, 0.7, Diagonals::uniform), 1);
    const Parameters parameters{.regularization = 1.2f, .sub_steps = 4, .stretch_ceiling = 1.05f};
    const Filtered given = filter_on_device(cloth, with_ceiling, parameters);
    for (std::size_t a = 0; a < cloth.rest_areas.size(); ++a) {
        double* M = cloth.rest_shapes.data() + 4 * a;
        const double angle = 0.3 + 0.1 * static_cast<double>(a), c = std::cos(angle), s = std::sin(angle);
        const double turned[4] = {c * M[0] - s * M[1], s * M[0] + c * M[1], c * M[2] - s * M[3], s * M[2] + c * M[3]};
        std::copy(std::begin(turned), std::end(turned), M);
        if (a % 2 == 0) {  // and mirrored
            M[0] = -M[0];
            M[2] = -M[2];
        }
    }
    const Filtered turned = filter_on_device(cloth, with_ceiling, parameters);
    CHECK(difference(turned.velocities, given.velocities) <= 1e-4 * norm(given.velocities));

    const MovingCloth flat = moving_cloth(grid(17, 13, 1.0, 0.7, Diagonals::uniform), 1);
    StrainLimiter limiter(device().context, device().id, flat.topology, with_ceiling);
    const CallerBuffers buffers({&flat, 1}, with_ceiling);
    const DeviceArray<float> shapes(poison<float>(flat.rest_shapes.size()));
    const Owned<cl_command_queue> queue = in_order_queue();
    // At the positions at hand, which are wavy: what counts is that they are those of the reference.
    require_success(
        wait_and_release(limiter.enqueue_rest_shapes(queue.get(), buffers.views().positions, {shapes.get(), 0})),
        "rest shapes");
    const std::vector<double> want = reference::rest_shapes<double>(*flat.topology, flat.positions);
    const std::vector<float> got = shapes.read();
    for (std::size_t n = 0; n < want.size(); ++n)
        CHECK(static_cast<double>(got[n]) == Approx(want[n]).epsilon(1e-4).margin(1e-3));
}

TEST_CASE("stretch ceiling: what is not finite ends a call and is named", "[filter][stretch_ceiling]") {
    const MovingCloth cloth = moving_cloth(grid(9, 9, 1.0, 1.0, Diagonals::alternating), 8);
    Options options = with_ceiling;
    options.stretch_ceiling_per_triangle = true;
    const Parameters parameters{.sub_steps = 4};
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        for (const auto member : {&MovingCloth::rest_shapes, &MovingCloth::stretch_ceilings}) {
            MovingCloth broken = cloth;
            const std::size_t width = (cloth.*member).size() / cloth.rest_areas.size();
            (broken.*member)[width * 17] = bad;
            const Filtered got = filter_on_device(broken, options, parameters);
            CHECK(got.stats.status == Status::diverged);
            CHECK(got.stats.offender == Offender::triangle);
            CHECK(got.stats.offender_index == 17);
            CHECK(got.velocities == cloth.velocities);
        }
}

TEST_CASE("stretch ceiling: a sheet thrown against its pins at 2, 5 and 10 m/s stays whole",
          "[filter][stretch_ceiling]") {
    constexpr double time_step = 1.0 / 60.0;
    Hanging start(65);
    StrainLimiter limiter(device().context, device().id, start.cloth.topology, with_ceiling);
    for (const double speed : {2.0, 5.0, 10.0}) {
        // At 10 m/s the pins' triangles would be drawn to 14 times their length in one step: 30 sub-steps tear them.
        constexpr Parameters parameters{.stretch_ceiling = 1.1f};
        Hanging curtain = start;
        for (std::size_t v = 0; v < curtain.cloth.inverse_masses.size(); ++v)
            if (curtain.cloth.inverse_masses[v] > 0.0) curtain.cloth.velocities[3 * v + 1] = speed;
        double stretch = 0.0, area_change = 0.0;
        std::int32_t fewest = 2 * parameters.sub_steps, most = 0;
        for (int frame = 0; frame < 40; ++frame) {
            curtain.accelerate(time_step);
            const CallerBuffers buffers({&curtain.cloth, 1}, with_ceiling);
            const Stats stats = filter(limiter, buffers, {&parameters, 1})[0];
            const std::vector<float> velocities = buffers.read_velocities();
            curtain.cloth.velocities.assign(velocities.begin(), velocities.end());
            REQUIRE(all_finite(curtain.cloth.velocities));
            fewest = std::min(fewest, stats.sub_steps);
            most = std::max(most, stats.sub_steps);
            stretch = std::max(stretch, static_cast<double>(stats.max_stretch));
            area_change = std::max(area_change, static_cast<double>(stats.max_area_change));
            curtain.move(time_step);
        }
        CAPTURE(speed, stretch, area_change, fewest, most);
        CHECK(stretch < 1.18);
        CHECK(area_change < 0.04);
        if (speed < 10.0)
            CHECK(fewest == parameters.sub_steps);
        else
            CHECK(most == 2 * parameters.sub_steps);
    }
}
