// SPDX-License-Identifier: MIT
#include "filter/filtered.hpp"
#include "host/queued_iterations.hpp"
#include "support/tolerances.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace apsl;
using namespace apsl::test;

TEST_CASE("Chebyshev agrees with the reference: whole and small steps, a fixed and a rising alpha", "[filter]") {
    const std::vector<MovingCloth> all = small_cloths();
    // The tolerance is the comparison's alone.
    const Parameters settings[] = {
        {.regularization = 1.3f, .sub_steps = 1, .tolerance = 1e-4f},
        {.regularization = 1.3f, .sub_steps = 3, .tolerance = 1e-4f, .stepping = Stepping::whole_step},
        {.regularization = 1.4f,
         .sub_steps = 4,
         .tolerance = 1e-4f,
         .first_regularization = 1.1f,
         .stepping = Stepping::whole_step},
        {.regularization = 1.4f,
         .sub_steps = 6,
         .tolerance = 3e-5f,
         .first_regularization = 1.1f,
         .stepping = Stepping::small_steps}};
    for (const auto& [work_group_size, bound_interval] : {std::pair{1u, 1u}, {1u, 100u}, {32u, 2u}, {64u, 1u}}) {
        Options options = by_chebyshev;
        options.work_group_size = work_group_size;
        options.bound_interval = bound_interval;
        StrainLimiter limiter(device().context, device().id, topologies_of(all), options);
        for (const Parameters& parameters : settings) {
            const CallerBuffers buffers(all, options);
            const std::vector<Stats> stats = filter(limiter, buffers, {&parameters, 1});
            const std::vector<float> velocities = buffers.read_velocities();
            auto begin = velocities.begin();
            for (std::size_t c = 0; c < all.size(); ++c) {
                CAPTURE(options.work_group_size, options.bound_interval, c, parameters.sub_steps);
                const auto end = begin + static_cast<std::ptrdiff_t>(all[c].velocities.size());
                check_against_reference({{begin, end}, stats[c]}, all[c], options, parameters);
                const Stats want = filter_with_reference(all[c], options, parameters).stats;
                CHECK(stats[c].iterations == want.iterations);
                CHECK(stats[c].residual == 0.0f);
                begin = end;
            }
        }
    }
}

TEST_CASE("Chebyshev: cloths with parameters of their own get the bytes they would get alone", "[filter]") {
    const std::vector<MovingCloth> all = small_cloths();
    // Schedules that rise and fall, other counts of sub-steps, one off, one at α = 1.
    const std::vector<Parameters> parameters{
        {.regularization = 1.4f, .sub_steps = 5, .first_regularization = 1.02f, .stepping = Stepping::small_steps},
        {.regularization = 1.02f, .sub_steps = 3, .first_regularization = 2.0f},
        {.regularization = 1.2f, .sub_steps = 7},
        {.regularization = 1.0f, .sub_steps = 2, .max_iterations = 9},
        {.enabled = false},
        {.regularization = 3.0f, .sub_steps = 1},
        {.regularization = 1.1f, .sub_steps = 0}};
    Options options = by_chebyshev;
    options.work_group_size = 1;  // sums over groups are grouped alike, whoever else is there
    StrainLimiter limiter(device().context, device().id, topologies_of(all), options);
    const CallerBuffers buffers(all, options);
    const std::vector<Stats> stats = filter(limiter, buffers, parameters);
    const std::vector<float> velocities = buffers.read_velocities();
    auto begin = velocities.begin();
    for (std::size_t c = 0; c < all.size(); ++c) {
        CAPTURE(c);
        const auto end = begin + static_cast<std::ptrdiff_t>(all[c].velocities.size());
        const Filtered alone = filter_on_device(all[c], options, parameters[c]);
        CHECK(std::equal(begin, end, alone.velocities.begin(), alone.velocities.end()));
        CHECK(stats[c].iterations == alone.stats.iterations);
        CHECK(stats[c].sub_steps == alone.stats.sub_steps);
        CHECK(stats[c].status == alone.stats.status);
        begin = end;
    }
    CHECK(stats[3].iterations == 18);  // at α = 1 as many products as there may be
    CHECK(stats[4].status == Status::off);
}

TEST_CASE("Chebyshev: what is not finite ends a call, and the next one is a fresh limiter's", "[filter]") {
    MovingCloth cloth = moving_cloth(grid(17, 17, 1.0, 1.0, Diagonals::alternating), 8);
    const Parameters parameters{.regularization = 1.1f, .sub_steps = 5, .stepping = Stepping::small_steps};
    StrainLimiter limiter(device().context, device().id, cloth.topology, by_chebyshev);
    const Filtered fresh = filter_on_device(cloth, by_chebyshev, parameters);
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e30}) {
        MovingCloth broken = cloth;
        broken.velocities[30] = bad;
        const CallerBuffers before({&broken, 1}, by_chebyshev);
        const std::vector<float> given = before.read_velocities();
        CHECK(filter(limiter, before, {&parameters, 1})[0].status == Status::diverged);
        CHECK(same_bytes(before.read_velocities(), given));
        const CallerBuffers after({&cloth, 1}, by_chebyshev);
        CHECK(filter(limiter, after, {&parameters, 1})[0].status == fresh.stats.status);
        const std::vector<float> velocities = after.read_velocities();
        CHECK(std::equal(velocities.begin(), velocities.end(), fresh.velocities.begin(), fresh.velocities.end()));
    }
}

TEST_CASE("queued products: those of the cloth with most of them", "[filter]") {
    using host::CallBudget, host::queued_products;
    CallBudget one;
    one.add(Parameters{.regularization = 1.4f, .sub_steps = 3, .first_regularization = 1.1f});
    CHECK(queued_products(one, 0, false) == 4);
    CHECK(queued_products(one, 2, false) == 2);
    CallBudget same = one;
    same.add(Parameters{.regularization = 1.4f, .sub_steps = 3, .first_regularization = 1.1f});
    CHECK(queued_products(same, 2, false) == 2);
    CallBudget others = one;
    others.add(Parameters{.regularization = 1.4f, .sub_steps = 5});
    for (int sub_step = 0; sub_step < 5; ++sub_step) CHECK(queued_products(others, sub_step, false) == 4);
    CallBudget undamped;
    undamped.add(Parameters{.regularization = 1.0f, .sub_steps = 2, .max_iterations = 9});
    CHECK(queued_products(undamped, 0, false) == 9);
}
