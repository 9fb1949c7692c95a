// SPDX-License-Identifier: MIT
//
// What a running program changes between two calls on one limiter: the next call is that of a fresh limiter, to the
// byte.
#include "embed/opencl_calls.hpp"
#include "embed/variants.hpp"
#include "embed/without_binaries.hpp"
#include "support/device_cloth.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <functional>

using namespace apsl;
using namespace apsl::test;

namespace {

MovingCloth a_cloth(std::uint32_t seed = 1) {
    return moving_cloth(grid(9, 9, 1.0, 1.0, Diagonals::alternating), seed);
}

constexpr Parameters few{.regularization = 2.0f, .sub_steps = 3};
/// 30 of them, in small steps. α is what the printed matrix needs.
constexpr Parameters small_steps{.regularization = 2.0f};

struct Outcome {
    std::vector<float> velocities;
    std::vector<Stats> stats;
};

Outcome outcome(StrainLimiter& limiter, std::span<const MovingCloth> cloths, std::span<const Parameters> parameters) {
    const CallerBuffers buffers(cloths, limiter.options());
    const std::vector<Stats> stats = filter(limiter, buffers, parameters);
    return {buffers.read_velocities(), stats};
}

/// Of one of several of a_cloth().
std::vector<float> velocities_of(std::size_t cloth, const std::vector<float>& velocities) {
    const auto first = velocities.begin() + static_cast<std::ptrdiff_t>(243 * cloth);
    return {first, first + 243};
}

void check_same(const Outcome& got, const Outcome& expected) {
    CHECK(same_bytes(got.velocities, expected.velocities));
    CHECK(same_bytes(got.stats, expected.stats));
}

/// A patch of these has three vertices a triangle.
Mesh triangles_apart(std::uint32_t count) {
    Mesh mesh;
    for (std::uint32_t t = 0; t < count; ++t) {
        const double x = 2.0 * t;
        mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
        mesh.positions.insert(mesh.positions.end(), {x, 0.0, 0.0, x + 1.0, 0.0, 0.0, x, 1.0, 0.0});
    }
    return mesh;
}

}  // namespace

TEST_CASE("pins, alpha, rest areas and time step change between calls without a rebuild", "[embed]") {
    struct Change {
        const char* what;
        std::function<void(MovingCloth&, Parameters&)> apply;
    };
    const Change changes[] = {
        {"one vertex pinned, another let go",
         [](MovingCloth& cloth, Parameters&) {
             cloth.inverse_masses[0] = cloth.inverse_masses[1];
             cloth.inverse_masses[20] = 0.0;
         }},
        {"alpha painted",
         [](MovingCloth& cloth, Parameters&) {
             for (std::size_t a = 0; a < 30; ++a) cloth.regularization[a] = 3.0;
         }},
        {"rest areas scaled",
         [](MovingCloth& cloth, Parameters&) {
             for (double& area : cloth.rest_areas) area = static_cast<float>(1.0625 * area);
         }},
        {"half the time step", [](MovingCloth&, Parameters& parameters) { parameters.time_step *= 0.5f; }}};
    for (Options options : variants) {
        options.regularization_per_triangle = true;
        StrainLimiter limiter(device().context, device().id, a_cloth().topology, options);
        const MovingCloth before = a_cloth();
        const Outcome unchanged = outcome(limiter, {&before, 1}, {&few, 1});
        for (const Change& change : changes) {
            CAPTURE(change.what, static_cast<int>(options.apply), static_cast<int>(options.execution));
            MovingCloth cloth = a_cloth();
            Parameters parameters = few;
            change.apply(cloth, parameters);
            const OpenClCalls calls = opencl_calls();
            const CallerBuffers buffers({&cloth, 1}, options);
            const int made_by_test = opencl_calls().allocations;
            filter(limiter, buffers, {&parameters, 1});
            CHECK(opencl_calls().builds == calls.builds);
            CHECK(opencl_calls().allocations == made_by_test);
            const Outcome got = outcome(limiter, {&cloth, 1}, {&parameters, 1});
            CHECK(same_bytes(buffers.read_velocities(), got.velocities));
            StrainLimiter fresh(device().context, device().id, cloth.topology, options);
            check_same(got, outcome(fresh, {&cloth, 1}, {&parameters, 1}));
            CHECK_FALSE(same_bytes(got.velocities, unchanged.velocities));
        }
    }
}

TEST_CASE("a cloth switched off is left alone, and the others never know", "[embed]") {
    MovingCloth broken = a_cloth(2);  // nobody looks at it while it is off
    broken.positions[7] = std::numeric_limits<double>::quiet_NaN();
    const std::vector<MovingCloth> cloths{a_cloth(1), broken, a_cloth(3)};
    const std::vector<MovingCloth> sane{cloths[0], a_cloth(2), cloths[2]};
    const std::vector<std::shared_ptr<const Topology>> topologies{cloths[0].topology, cloths[1].topology,
                                                                  cloths[2].topology};
    for (Options options : variants)
        for (const auto& [kept, given] : {std::pair{0u, few}, {2u, few}, {0u, small_steps}}) {
            options.warm_start_sub_steps = kept;
            std::vector<Parameters> parameters(3, given);
            parameters[1].enabled = false;
            CAPTURE(static_cast<int>(options.apply), static_cast<int>(options.execution), kept, given.sub_steps);
            StrainLimiter limiter(device().context, device().id, topologies, options);
            StrainLimiter all_on(device().context, device().id, topologies, options);
            const Outcome on = outcome(all_on, sane, {&given, 1});
            const Outcome got = outcome(limiter, cloths, parameters);
            const std::vector<float> unfiltered = CallerBuffers(cloths, options).read_velocities();
            CHECK(same_bytes(velocities_of(1, got.velocities), velocities_of(1, unfiltered)));
            for (const std::size_t c : {std::size_t{0}, std::size_t{2}})
                CHECK(same_bytes(velocities_of(c, got.velocities), velocities_of(c, on.velocities)));
            CHECK(same_bytes(std::vector{got.stats[0], got.stats[2]}, std::vector{on.stats[0], on.stats[2]}));
            Stats off{};
            off.status = Status::off;
            CHECK(same_bytes(std::vector{got.stats[1]}, std::vector{off}));

            // Off left nothing behind: switched on, it has its first call.
            const Outcome next = outcome(limiter, sane, {&given, 1});
            CHECK(same_bytes(std::vector{next.stats[1]}, std::vector{on.stats[1]}));
            CHECK(same_bytes(velocities_of(1, next.velocities), velocities_of(1, on.velocities)));

            Parameters none = given;
            none.enabled = false;
            const Outcome all_off = outcome(limiter, sane, {&none, 1});
            CHECK(same_bytes(all_off.velocities, CallerBuffers(sane, options).read_velocities()));
            for (const Stats& stats : all_off.stats) CHECK(same_bytes(std::vector{stats}, std::vector{off}));
        }
}

TEST_CASE("rest positions in place of rest areas: areas of the reference, in every layout's place", "[embed]") {
    const std::vector<MovingCloth> cloths{a_cloth(1), moving_cloth(tetrahedron(), 2)};
    const std::vector<std::shared_ptr<const Topology>> topologies{cloths[0].topology, cloths[1].topology};
    for (const Execution execution : {Execution::many_groups, Execution::one_group})
        for (const std::uint32_t stride : {3u, 4u}) {
            const Options options{.execution = execution, .position_stride = stride};
            const CallerBuffers buffers(cloths, options, 5);
            StrainLimiter limiter(device().context, device().id, topologies, options);
            const DeviceArray<float> areas(poison<float>(7 + 128 + 4));
            const Owned<cl_command_queue> queue = in_order_queue();
            const BufferView rest_areas{areas.get(), 28};
            require_success(
                wait_and_release(limiter.enqueue_rest_areas(queue.get(), buffers.views().positions, rest_areas)),
                "the rest areas");
            // They are of the wavy positions: a cloth that does not move is at rest there.
            Buffers views = buffers.views();
            views.rest_areas = rest_areas;
            std::vector<MovingCloth> still = cloths;
            for (MovingCloth& cloth : still) cloth.velocities.assign(cloth.velocities.size(), 0.0);
            const CallerBuffers at_rest(still, options, 5);
            views.velocities = at_rest.views().velocities;
            std::vector<Stats> stats(2);
            require_success(wait_and_release(limiter.enqueue(queue.get(), views, Parameters{.sub_steps = 0})),
                            "the filter");
            require_success(wait_and_release(limiter.read_stats(queue.get(), stats)), "the statistics");
            for (const Stats& s : stats) CHECK(s.initial_max_area_change < 1e-6f);
            const std::vector<float> got = areas.read();
            for (std::size_t n = 0; n < got.size(); ++n) CHECK((n < 7 ? !(got[n] > 0.0f) : got[n] > 0.0f));
            CHECK_THROWS_WITH(limiter.enqueue_rest_areas(queue.get(), {}, rest_areas), "rest_positions is null");
        }
}

TEST_CASE("rebuilt for other topologies a limiter is a fresh one, without compiling", "[embed]") {
    Mesh torn = grid(9, 9, 1.0, 1.0, Diagonals::alternating);
    torn.triangles.resize(torn.triangles.size() - 20);
    const MovingCloth cloth = a_cloth(), tear = moving_cloth(torn, 3);
    const std::vector<MovingCloth> two{tear, a_cloth(4)};
    const std::vector<std::shared_ptr<const Topology>> topologies{two[0].topology, two[1].topology};
    for (Options options : variants) {
        CAPTURE(static_cast<int>(options.apply), static_cast<int>(options.execution));
        StrainLimiter limiter(device().context, device().id, cloth.topology, options);
        StrainLimiter fresh(device().context, device().id, tear.topology, options);
        StrainLimiter fresh_two(device().context, device().id, topologies, options);
        outcome(limiter, {&cloth, 1}, {&few, 1});

        const int builds = opencl_calls().builds;
        limiter.rebuild(tear.topology);
        for (const Parameters& parameters : {few, small_steps})
            check_same(outcome(limiter, {&tear, 1}, {&parameters, 1}), outcome(fresh, {&tear, 1}, {&parameters, 1}));
        CHECK(limiter.scratch_bytes() == fresh.scratch_bytes());
        limiter.rebuild(topologies);
        for (const Parameters& parameters : {few, small_steps})
            check_same(outcome(limiter, two, {&parameters, 1}), outcome(fresh_two, two, {&parameters, 1}));
        CHECK(limiter.cloth_count() == 2);
        CHECK(opencl_calls().builds == builds);

        // What cannot be built leaves the limiter as it was.
        CHECK_THROWS_AS(limiter.rebuild(std::shared_ptr<const Topology>()), Error);
        check_same(outcome(limiter, two, {&few, 1}), outcome(fresh_two, two, {&few, 1}));
    }
}

TEST_CASE("a rebuild for patches that the program has no room for compiles another, once", "[embed]") {
    const MovingCloth small = moving_cloth(tetrahedron(), 1);
    const MovingCloth large = moving_cloth(triangles_apart(600), 2);
    StrainLimiter limiter(device().context, device().id, small.topology);
    StrainLimiter fresh(device().context, device().id, large.topology);
    const int builds = opencl_calls().builds;
    limiter.rebuild(large.topology);
    CHECK(opencl_calls().builds == builds + 1);
    check_same(outcome(limiter, {&large, 1}, {&few, 1}), outcome(fresh, {&large, 1}, {&few, 1}));
    limiter.rebuild(small.topology);
    limiter.rebuild(large.topology);
    CHECK(opencl_calls().builds == builds + 1);
}

TEST_CASE("a rebuild keeps what became of the program binary, unless it compiles", "[embed]") {
    if (without_binaries()) return;
    const MovingCloth small = moving_cloth(tetrahedron(), 1);
    const MovingCloth large = moving_cloth(triangles_apart(600), 2);
    StrainLimiter first(device().context, device().id, small.topology);
    outcome(first, {&small, 1}, {&few, 1});
    const std::vector<std::byte> binary = first.program_binary();
    StrainLimiter limiter(device().context, device().id, small.topology, {}, binary);
    REQUIRE(limiter.program_binary_use() == ProgramBinaryUse::taken);
    limiter.rebuild(moving_cloth(right_triangle(), 3).topology);
    CHECK(limiter.program_binary_use() == ProgramBinaryUse::taken);
    StrainLimiter again(device().context, device().id, small.topology, {}, limiter.program_binary());
    CHECK(again.program_binary_use() == ProgramBinaryUse::taken);
    limiter.rebuild(large.topology);
    CHECK(limiter.program_binary_use() == ProgramBinaryUse::none_given);
    StrainLimiter fresh(device().context, device().id, large.topology, limiter.options(), limiter.program_binary());
    CHECK(fresh.program_binary_use() == ProgramBinaryUse::taken);
    check_same(outcome(limiter, {&large, 1}, {&few, 1}), outcome(fresh, {&large, 1}, {&few, 1}));
}

TEST_CASE("a limiter in the caller's scratch memory allocates nothing, and gives the same bytes", "[embed]") {
    const std::vector<MovingCloth> cloths{a_cloth(1), moving_cloth(tetrahedron(), 2)};
    const std::vector<std::shared_ptr<const Topology>> topologies{cloths[0].topology, cloths[1].topology};
    for (const Options& options : variants)
        for (const std::size_t offset : {std::size_t{0}, std::size_t{20}}) {
            CAPTURE(static_cast<int>(options.apply), static_cast<int>(options.execution), offset);
            StrainLimiter own(device().context, device().id, topologies, options);
            const std::size_t needed = StrainLimiter::required_scratch_bytes(device().id, topologies, options);
            CHECK(needed >= own.scratch_bytes());
            cl_int status = CL_SUCCESS;
            std::vector<unsigned char> poisoned(offset + needed + 64, 0xFF);
            const Owned<cl_mem> scratch(clCreateBuffer(device().context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR,
                                                       poisoned.size(), poisoned.data(), &status),
                                        clReleaseMemObject);
            require_success(status, "clCreateBuffer");
            const int allocations = opencl_calls().allocations;
            StrainLimiter limiter(device().context, device().id, topologies, options, {}, {scratch.get(), offset});
            CHECK(opencl_calls().allocations == allocations);
            CHECK(limiter.scratch_bytes() == own.scratch_bytes());
            for (const Parameters& parameters : {few, small_steps})
                check_same(outcome(limiter, cloths, {&parameters, 1}), outcome(own, cloths, {&parameters, 1}));

            const Owned<cl_command_queue> queue = in_order_queue();
            std::vector<unsigned char> after(poisoned.size());
            require_success(clEnqueueReadBuffer(queue.get(), scratch.get(), CL_TRUE, 0, after.size(), after.data(), 0,
                                                nullptr, nullptr),
                            "clEnqueueReadBuffer");
            for (std::size_t n = 0; n < after.size(); ++n)
                if ((n < offset || n >= offset + needed) && after[n] != 0xFF) FAIL("byte " << n << " was written");

            // Out of it and back into it.
            limiter.rebuild(topologies);
            check_same(outcome(limiter, cloths, {&few, 1}), outcome(own, cloths, {&few, 1}));
            const int before = opencl_calls().allocations;
            limiter.rebuild(topologies, {scratch.get(), offset});
            CHECK(opencl_calls().allocations == before);
            check_same(outcome(limiter, cloths, {&few, 1}), outcome(own, cloths, {&few, 1}));

            CHECK_THROWS_WITH(
                StrainLimiter(device().context, device().id, topologies, options, {}, {scratch.get(), needed / 2}),
                Catch::StartsWith("scratch holds"));
        }
}

TEST_CASE("statistics of no call are zeros, before the first one and after a rebuild", "[embed]") {
    const MovingCloth cloth = a_cloth();
    const Owned<cl_command_queue> queue = in_order_queue();
    for (const Options& options : {variants[1], variants[4]}) {
        StrainLimiter limiter(device().context, device().id, cloth.topology, options);
        const auto check_zeros = [&] {
            Stats stats;
            std::memset(&stats, 0xFF, sizeof stats);
            require_success(wait_and_release(limiter.read_stats(queue.get(), {&stats, 1})), "the statistics");
            const Stats zeros{};
            CHECK(std::memcmp(&stats, &zeros, sizeof stats) == 0);
        };
        check_zeros();
        const CallerBuffers buffers({&cloth, 1}, options);
        const Parameters parameters{.sub_steps = 2};
        CHECK(filter(limiter, buffers, {&parameters, 1})[0].sub_steps == 2);
        limiter.rebuild(cloth.topology);
        check_zeros();
    }
}
