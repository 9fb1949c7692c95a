// SPDX-License-Identifier: MIT
#include "embed/refusals.hpp"
#include "embed/small_limiter.hpp"

#include <catch2/catch.hpp>
#include <functional>
#include <limits>

using namespace apsl;
using namespace apsl::test;

TEST_CASE("the constructor refuses what it cannot build, in one line", "[embed]") {
    const auto options = [](const Options& o) { return [o] { limiter(o); }; };
    check_invalid("position_stride is 2, expected at least 3", options({.position_stride = 2}));
    check_invalid("velocity_stride is 0, expected at least 3", options({.velocity_stride = 0}));
    check_invalid("position_component_stride is 0", options({.position_component_stride = 0}));
    check_invalid("velocity_component_stride is 24, expected at least 25 for 25 vertices with velocity_stride 1",
                  options({.velocity_stride = 1, .velocity_component_stride = 24}));
    check_invalid("position_stride is 0", options({.position_stride = 0, .position_component_stride = 25}));
    check_invalid("inverse_mass_stride is 0", options({.inverse_mass_stride = 0}));
    check_invalid("work_group_size is 48, expected a power of two", options({.work_group_size = 48}));
    check_invalid("matrix", options({.matrix = static_cast<Matrix>(7)}));
    check_invalid("apply", options({.apply = static_cast<Apply>(-1)}));
    check_invalid("execution", options({.execution = static_cast<Execution>(3)}));
    check_invalid("execution is one_group, which needs the consistent matrix, matrix-free",
                  options({.matrix = Matrix::printed, .execution = Execution::one_group}));
    check_invalid("execution is one_group, which needs the consistent matrix, matrix-free",
                  options({.apply = Apply::assembled_csr, .execution = Execution::one_group}));
    check_invalid("warm_start_sub_steps is 4294967295, expected a whole number >= 0 and <= 65536",
                  options({.warm_start_sub_steps = UINT32_MAX}));
    check_invalid("bound_interval is 0, expected a whole number >= 1", options({.bound_interval = 0}));
    check_invalid("solver is 3, expected conjugate_gradient (0), chebyshev (1) or automatic (2)",
                  options({.solver = static_cast<Solver>(3)}));
    check_invalid("solver is chebyshev, which needs the consistent matrix, matrix-free",
                  options({.matrix = Matrix::printed, .solver = Solver::chebyshev}));
    check_invalid("solver is chebyshev, which needs the consistent matrix, matrix-free",
                  options({.apply = Apply::assembled_csr, .solver = Solver::chebyshev}));
    check_invalid("solver is chebyshev, which takes no warm_start_sub_steps",
                  options({.warm_start_sub_steps = 1, .solver = Solver::chebyshev}));
    check_invalid("solver is chebyshev, which needs one regularization for all triangles",
                  options({.regularization_per_triangle = true, .solver = Solver::chebyshev}));
    check_invalid("execution is one_group, which needs solver conjugate_gradient",
                  options({.execution = Execution::one_group, .solver = Solver::chebyshev}));
    check_error(ErrorCode::unsupported, "work_group_size is 1073741824", options({.work_group_size = 1u << 30}));

    const std::vector<std::shared_ptr<const Topology>> none;
    check_invalid("no cloths", [&] { StrainLimiter(device().context, device().id, none); });
    check_invalid("null", [&] { StrainLimiter(device().context, device().id, std::shared_ptr<const Topology>()); });
    check_invalid("context is null", [&] { StrainLimiter(nullptr, device().id, cloth().topology); });
    check_invalid("device is null", [&] { StrainLimiter(device().context, nullptr, cloth().topology); });
}

TEST_CASE("enqueue refuses parameters out of range, and queues nothing", "[embed]") {
    StrainLimiter made = limiter();
    const CallerBuffers buffers({&cloth(), 1}, {});
    const Owned<cl_command_queue> queue = in_order_queue();
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const auto parameters = [&](const Parameters& p) {
        return [&, p] { clReleaseEvent(made.enqueue(queue.get(), buffers.views(), p)); };
    };
    check_invalid("regularization is 0.99, expected a finite number >= 1", parameters({.regularization = 0.99f}));
    check_invalid("regularization is nan", parameters({.regularization = nan}));
    check_invalid("time_step is 0", parameters({.time_step = 0.0f}));
    check_invalid("time_step is nan", parameters({.time_step = nan}));
    check_invalid("time_step is inf", parameters({.time_step = infinity}));
    check_invalid("adaptive_threshold is -1", parameters({.adaptive_threshold = -1}));
    check_invalid("first_regularization is 1, expected 0", parameters({.first_regularization = 1.0f}));
    check_invalid("sub_steps is -1", parameters({.sub_steps = -1}));
    check_invalid("target_area_change is -0.1", parameters({.target_area_change = -0.1f}));
    check_invalid("target_area_change is nan", parameters({.target_area_change = nan}));
    check_invalid("tolerance is 1", parameters({.tolerance = 1.0f}));
    check_invalid("tolerance is nan", parameters({.tolerance = nan}));
    check_invalid("max_iterations is 0", parameters({.max_iterations = 0}));
    check_invalid("max_iterations is 10001", parameters({.max_iterations = 10001}));

    const std::vector<Parameters> two(2);
    const std::vector<Parameters> none;
    for (const auto& wrong_count : {two, none})
        check_invalid(std::to_string(wrong_count.size()) + " parameters given for 1 cloths",
                      [&] { clReleaseEvent(made.enqueue(queue.get(), buffers.views(), wrong_count)); });
    CHECK(same_bytes(buffers.read_velocities(), CallerBuffers({&cloth(), 1}, {}).read_velocities()));
}

TEST_CASE("enqueue refuses a call of more launches than it may queue, and queues nothing", "[embed]") {
    const CallerBuffers buffers({&cloth(), 1}, {});
    const Owned<cl_command_queue> queue = in_order_queue();
    Buffers views = buffers.views();
    // What is not refused for its launches is refused for this one.
    views.rest_areas = {};
    const auto refused = [&](const std::string& what, const Options& options, const Parameters& parameters) {
        StrainLimiter made = limiter(options);
        check_invalid(what, [&] { clReleaseEvent(made.enqueue(queue.get(), views, parameters)); });
    };
    const std::string rest = " sub-steps, expected at most 1000000; lower sub_steps";
    const std::string no_areas = "buffers.rest_areas is null";
    // Nothing bounds a solve: an iteration of CG is two launches.
    const Options many{.execution = Execution::many_groups};
    const Parameters endless{.regularization = 1.0f, .sub_steps = 51, .max_iterations = 10000};
    refused("would queue 1020000 launches for solves and bending in 51" + rest, many, endless);
    Parameters as_many_as_may_be = endless;
    as_many_as_may_be.sub_steps = 50;
    refused(no_areas, many, as_many_as_may_be);
    // One launch for all of it.
    refused(no_areas, {.execution = Execution::one_group}, endless);
    // A product is a launch, and sub-steps are twice as many where stretch asks for them.
    const Options stretch{.limits_stretch = true};
    Parameters ceiling = endless;
    ceiling.stretch_ceiling = 1.1f;
    refused("would queue 1020000 launches for solves and bending in 102" + rest, stretch, ceiling);
    ceiling.sub_steps = 50;
    refused(no_areas, stretch, ceiling);
    refused(no_areas, stretch, {.sub_steps = 10000, .stretch_ceiling = 1.1f});
}

TEST_CASE("enqueue refuses velocities that share floats with the positions, and takes those that alternate",
          "[embed]") {
    const std::size_t vertices = cloth().topology->vertex_count();
    const DeviceArray<float> both(std::vector<float>(12 * vertices));
    const CallerBuffers others({&cloth(), 1}, {});
    const Owned<cl_command_queue> queue = in_order_queue();
    // The velocities' first float behind that of the positions; strides of 3 or 6.
    const auto enqueue = [&](std::size_t floats, std::uint32_t stride) {
        StrainLimiter made = limiter({.position_stride = stride, .velocity_stride = stride});
        Buffers views = others.views();
        views.positions = {both.get(), 0};
        views.velocities = {both.get(), 4 * floats};
        const cl_event done = made.enqueue(queue.get(), views, Parameters{});
        clWaitForEvents(1, &done);
        clReleaseEvent(done);
    };
    for (const std::size_t floats : {std::size_t{0}, std::size_t{2}, std::size_t{3}, 3 * vertices - 1})
        check_invalid("buffers.velocities overlaps buffers.positions", [&] { enqueue(floats, 3); });
    for (const std::size_t floats : {std::size_t{2}, std::size_t{4}, std::size_t{6}})
        check_invalid("buffers.velocities overlaps buffers.positions", [&] { enqueue(floats, 6); });
    enqueue(3 * vertices, 3);
    enqueue(3, 6);
}

TEST_CASE("enqueue refuses buffers it cannot use, names them, and queues nothing", "[embed]") {
    const Options options{.regularization_per_triangle = true};
    StrainLimiter made = limiter(options);
    const CallerBuffers buffers({&cloth(), 1}, options);
    const Owned<cl_command_queue> queue = in_order_queue();
    const std::pair<const char*, BufferView Buffers::*> fields[] = {{"positions", &Buffers::positions},
                                                                    {"velocities", &Buffers::velocities},
                                                                    {"inverse_masses", &Buffers::inverse_masses},
                                                                    {"rest_areas", &Buffers::rest_areas},
                                                                    {"regularization", &Buffers::regularization}};
    for (const auto& [name, field] : fields) {
        const auto with = [&, field = field](const std::function<void(BufferView&)>& change) {
            Buffers views = buffers.views();
            change(views.*field);
            return [&made, &queue, views] { clReleaseEvent(made.enqueue(queue.get(), views, Parameters{})); };
        };
        const std::string buffer = std::string("buffers.") + name;
        check_invalid(buffer + " is null", with([](BufferView& view) { view.buffer = nullptr; }));
        check_invalid(buffer + " has offset 2", with([](BufferView& view) { view.offset = 2; }));
        check_invalid(buffer + " holds", with([](BufferView& view) { view.offset = 4; }));  // one float too few
        check_invalid(buffer, with([](BufferView& view) { view.offset = SIZE_MAX - 3; }));
    }
    StrainLimiter by_chebyshev = limiter({.solver = Solver::chebyshev});
    CHECK(by_chebyshev.options().execution == Execution::many_groups);
    check_invalid("adaptive_threshold is 4, expected 0: the solver is chebyshev", [&] {
        clReleaseEvent(by_chebyshev.enqueue(queue.get(), CallerBuffers({&cloth(), 1}, {}).views(),
                                            Parameters{.adaptive_threshold = 4}));
    });
    StrainLimiter positions_alone = limiter({.positions_only = true});
    check_invalid("buffers.velocities is given, but Options::positions_only is on", [&] {
        clReleaseEvent(positions_alone.enqueue(queue.get(), CallerBuffers({&cloth(), 1}, {}).views(), Parameters{}));
    });
    check_invalid("stepping is small_steps, which needs velocities", [&] {
        Buffers views = CallerBuffers({&cloth(), 1}, {}).views();
        views.velocities = {};
        clReleaseEvent(positions_alone.enqueue(queue.get(), views, {.stepping = Stepping::small_steps}));
    });
    StrainLimiter without = limiter();
    check_invalid("regularization_per_triangle is off",
                  [&] { clReleaseEvent(without.enqueue(queue.get(), buffers.views(), Parameters{})); });
    check_invalid("queue is null", [&] { clReleaseEvent(made.enqueue(nullptr, buffers.views(), Parameters{})); });
    CHECK(same_bytes(buffers.read_velocities(), CallerBuffers({&cloth(), 1}, options).read_velocities()));
}

TEST_CASE("read_stats refuses a wrong number of entries", "[embed]") {
    const StrainLimiter made = limiter();
    const Owned<cl_command_queue> queue = in_order_queue();
    std::vector<Stats> stats(3);
    check_invalid("3 statistics asked for", [&] { clReleaseEvent(made.read_stats(queue.get(), stats)); });
}

TEST_CASE("a limiter that refused a call still does the next one", "[embed]") {
    StrainLimiter made = limiter();
    const CallerBuffers buffers({&cloth(), 1}, {}), expected({&cloth(), 1}, {});
    StrainLimiter fresh = limiter();
    const Parameters parameters{.sub_steps = 2};
    filter(fresh, expected, {&parameters, 1});
    const Owned<cl_command_queue> queue = in_order_queue();
    CHECK_THROWS_AS(made.enqueue(queue.get(), Buffers{}, parameters), Error);
    CHECK_THROWS_AS(made.enqueue(queue.get(), buffers.views(), Parameters{.regularization = 0.0f}), Error);
    filter(made, buffers, {&parameters, 1});
    CHECK(same_bytes(buffers.read_velocities(), expected.read_velocities()));
}
