// SPDX-License-Identifier: MIT
//
// Buffers, queues and events that a call cannot use: refused by name, before anything is queued.
#include "embed/c_views.hpp"
#include "embed/opencl_calls.hpp"
#include "embed/refusals.hpp"
#include "embed/small_limiter.hpp"

#include <apsl/apsl.h>

#include <catch2/catch.hpp>
#include <functional>
#include <string>

using namespace apsl;
using namespace apsl::test;

namespace {

constexpr std::size_t room = 4096;  // bytes, enough for any buffer of cloth()

Owned<cl_mem> memory(cl_mem_flags flags, cl_context context = device().context, std::size_t bytes = room) {
    cl_int status = CL_SUCCESS;
    Owned<cl_mem> made(clCreateBuffer(context, flags, bytes, nullptr, &status), clReleaseMemObject);
    require_success(status, "clCreateBuffer");
    return made;
}

Owned<cl_mem> part_of(const Owned<cl_mem>& buffer, cl_mem_flags flags) {
    cl_int status = CL_SUCCESS;
    const cl_buffer_region region{0, room};
    Owned<cl_mem> made(clCreateSubBuffer(buffer.get(), flags, CL_BUFFER_CREATE_TYPE_REGION, &region, &status),
                       clReleaseMemObject);
    require_success(status, "clCreateSubBuffer");
    return made;
}

Owned<cl_mem> image() {
    cl_int status = CL_SUCCESS;
    const cl_image_format format{CL_RGBA, CL_FLOAT};
    cl_image_desc description{};
    description.image_type = CL_MEM_OBJECT_IMAGE2D;
    description.image_width = description.image_height = 16;
    Owned<cl_mem> made(clCreateImage(device().context, CL_MEM_READ_WRITE, &format, &description, nullptr, &status),
                       clReleaseMemObject);
    require_success(status, "clCreateImage");
    return made;
}

struct OtherContext {
    Owned<cl_context> context;
    Owned<cl_command_queue> queue;
    Owned<cl_event> event;

    OtherContext() {
        cl_int status = CL_SUCCESS;
        context = {clCreateContext(nullptr, 1, &device().id, nullptr, nullptr, &status), clReleaseContext};
        require_success(status, "clCreateContext");
        queue = {clCreateCommandQueue(context.get(), device().id, 0, &status), clReleaseCommandQueue};
        require_success(status, "clCreateCommandQueue");
        event = {clCreateUserEvent(context.get(), &status), clReleaseEvent};
        require_success(status, "clCreateUserEvent");
    }
};

struct View {
    const char* name;
    BufferView Buffers::* field;
    bool written;
};
constexpr View views_of_velocities[] = {{"buffers.positions", &Buffers::positions, false},
                                        {"buffers.velocities", &Buffers::velocities, true},
                                        {"buffers.inverse_masses", &Buffers::inverse_masses, false},
                                        {"buffers.rest_areas", &Buffers::rest_areas, false},
                                        {"buffers.regularization", &Buffers::regularization, false}};
constexpr View views_of_positions_only[] = {{"buffers.positions", &Buffers::positions, true},
                                            {"buffers.inverse_masses", &Buffers::inverse_masses, false},
                                            {"buffers.rest_areas", &Buffers::rest_areas, false}};

void check_flags(const Options& options, std::span<const View> views) {
    StrainLimiter made = limiter(options);
    const CallerBuffers buffers({&cloth(), 1}, options);
    const Owned<cl_command_queue> queue = in_order_queue();
    for (const auto& [name, field, written] : views) {
        CAPTURE(name);
        const auto with = [&, field = field](const Owned<cl_mem>& buffer) {
            return [&, field, buffer] {
                Buffers given = buffers.views();
                if (options.positions_only) given.velocities = {};
                given.*field = {buffer.get()};
                require_success(wait_and_release(made.enqueue(queue.get(), given, Parameters{.sub_steps = 1})),
                                "the filter");
            };
        };
        const auto read_only = memory(CL_MEM_READ_ONLY), write_only = memory(CL_MEM_WRITE_ONLY);
        const std::string buffer = name;
        for (const auto& unreadable : {write_only, part_of(write_only, 0), part_of(write_only, CL_MEM_WRITE_ONLY)})
            check_invalid(buffer + " is CL_MEM_WRITE_ONLY, expected a buffer that kernels may read", with(unreadable));
        for (const auto& unwritable :
             {read_only, part_of(read_only, 0), part_of(memory(CL_MEM_READ_WRITE), CL_MEM_READ_ONLY)}) {
            if (written)
                check_invalid(buffer + " is CL_MEM_READ_ONLY, expected a buffer that kernels may write",
                              with(unwritable));
            else
                CHECK_NOTHROW(with(unwritable)());
        }
        // What the host may do with a buffer is no concern of the kernels'.
        CHECK_NOTHROW(with(memory(CL_MEM_READ_WRITE | CL_MEM_HOST_NO_ACCESS))());
        CHECK_NOTHROW(with(memory(0))());
        check_invalid(buffer + " is an image or a pipe, expected a buffer", with(image()));
        const OtherContext other;
        check_invalid(buffer + " is of another context", with(memory(CL_MEM_READ_WRITE, other.context.get())));
    }
}

}  // namespace

TEST_CASE("buffers are refused that kernels may not read or write, images, and buffers of another context", "[embed]") {
    check_flags({.regularization_per_triangle = true}, views_of_velocities);
    check_flags({.positions_only = true}, views_of_positions_only);
}

TEST_CASE("rest areas: buffers are refused that kernels may not read or write", "[embed]") {
    StrainLimiter made = limiter();
    const Owned<cl_command_queue> queue = in_order_queue();
    const auto measure = [&](cl_mem_flags positions, cl_mem_flags areas) {
        return [&, positions, areas] {
            const auto from = memory(positions), to = memory(areas);
            require_success(wait_and_release(made.enqueue_rest_areas(queue.get(), {from.get()}, {to.get()})),
                            "the rest areas");
        };
    };
    check_invalid("rest_positions is CL_MEM_WRITE_ONLY", measure(CL_MEM_WRITE_ONLY, CL_MEM_READ_WRITE));
    check_invalid("rest_areas is CL_MEM_READ_ONLY", measure(CL_MEM_READ_WRITE, CL_MEM_READ_ONLY));
    CHECK_NOTHROW(measure(CL_MEM_READ_ONLY, CL_MEM_WRITE_ONLY)());
    const OtherContext other;
    const auto elsewhere = memory(CL_MEM_READ_WRITE, other.context.get()), here = memory(CL_MEM_READ_WRITE);
    check_invalid("rest_positions is of another context",
                  [&] { clReleaseEvent(made.enqueue_rest_areas(queue.get(), {elsewhere.get()}, {here.get()})); });
    check_invalid("rest_areas is of another context",
                  [&] { clReleaseEvent(made.enqueue_rest_areas(queue.get(), {here.get()}, {elsewhere.get()})); });
}

TEST_CASE("scratch memory that cannot be cut and filled is refused, by the constructor and by rebuild", "[embed]") {
    const std::size_t needed = StrainLimiter::required_scratch_bytes(device().id, {&cloth().topology, 1});
    const auto scratch = [&](cl_mem_flags flags, cl_context context = device().context) {
        return memory(flags, context, needed + room);
    };
    StrainLimiter made = limiter();
    const OtherContext other;
    const std::pair<const char*, Owned<cl_mem>> unusable[] = {
        {"scratch is CL_MEM_READ_ONLY", scratch(CL_MEM_READ_ONLY)},
        {"scratch is CL_MEM_READ_ONLY or CL_MEM_WRITE_ONLY", scratch(CL_MEM_WRITE_ONLY)},
        {"scratch has a CL_MEM_HOST_ flag", scratch(CL_MEM_HOST_NO_ACCESS)},
        {"scratch has a CL_MEM_HOST_ flag", scratch(CL_MEM_HOST_READ_ONLY)},
        {"scratch has a CL_MEM_HOST_ flag", scratch(CL_MEM_HOST_WRITE_ONLY)},
        {"scratch is a sub-buffer", part_of(scratch(CL_MEM_READ_WRITE), 0)},
        {"scratch is an image", image()},
        {"scratch is of another context", scratch(CL_MEM_READ_WRITE, other.context.get())}};
    for (const auto& [what, buffer] : unusable) {
        const BufferView view{buffer.get()};
        check_invalid(what, [&] { StrainLimiter(device().context, device().id, cloth().topology, {}, {}, view); });
        check_invalid(what, [&] { made.rebuild(cloth().topology, view); });
    }
    const auto usable = scratch(CL_MEM_READ_WRITE);
    for (const std::size_t offset : {1, 2, 1026}) {
        const std::string what = "scratch has offset " + std::to_string(offset) + ", expected a multiple of 4 bytes";
        const BufferView view{usable.get(), offset};
        check_invalid(what, [&] { StrainLimiter(device().context, device().id, cloth().topology, {}, {}, view); });
        check_invalid(what, [&] { made.rebuild(cloth().topology, view); });
    }
    CHECK_NOTHROW(StrainLimiter(device().context, device().id, cloth().topology, {}, {}, {usable.get(), 4}));
    const Parameters parameters;
    CHECK(filter(made, CallerBuffers({&cloth(), 1}, {}), {&parameters, 1})[0].status == Status::ok);
}

TEST_CASE("a rebuild into the limiter's present scratch memory is refused, and harms nothing there", "[embed]") {
    const std::size_t needed = StrainLimiter::required_scratch_bytes(device().id, {&cloth().topology, 1});
    const Owned<cl_mem> scratch = memory(CL_MEM_READ_WRITE, device().context, 3 * needed);
    const BufferView middle{scratch.get(), needed};
    StrainLimiter made(device().context, device().id, cloth().topology, {}, {}, middle);
    // Clear of the present memory at first, into it with its last bytes; and the other way round.
    for (const std::size_t offset : {needed / 2, needed, needed + needed / 2})
        CHECK_THROWS_WITH(made.rebuild(cloth().topology, {scratch.get(), offset}),
                          Catch::Contains("overlaps the limiter's present memory"));
    const Parameters parameters;
    const CallerBuffers buffers({&cloth(), 1}, {}), expected({&cloth(), 1}, {});
    StrainLimiter fresh = limiter();
    filter(fresh, expected, {&parameters, 1});
    filter(made, buffers, {&parameters, 1});
    CHECK(same_bytes(buffers.read_velocities(), expected.read_velocities()));
    CHECK_NOTHROW(made.rebuild(cloth().topology, {scratch.get(), 2 * needed}));
    CHECK_NOTHROW(made.rebuild(cloth().topology, {scratch.get(), 0}));
}

namespace {

/// Every entry point that takes a queue and events must refuse these, in C++ and in C.
void check_refused(StrainLimiter& made, apsl_limiter* in_c, const std::string& what, cl_command_queue queue,
                   const std::vector<cl_event>& wait_list) {
    const CallerBuffers buffers({&cloth(), 1}, {});
    const Buffers views = buffers.views();
    std::vector<Stats> stats(1);
    check_invalid(what, [&] { clReleaseEvent(made.enqueue(queue, views, Parameters{}, wait_list)); });
    check_invalid(
        what, [&] { clReleaseEvent(made.enqueue_rest_areas(queue, views.positions, views.rest_areas, wait_list)); });
    const int reads = opencl_calls().reads;
    check_invalid(what, [&] { clReleaseEvent(made.read_stats(queue, stats, wait_list)); });

    const apsl_buffers in_c_views = c_views(views);
    const apsl_parameters parameters = apsl_default_parameters();
    apsl_stats c_stats{};
    cl_event event = nullptr;
    const auto count = static_cast<cl_uint>(wait_list.size());
    const auto check_in_c = [&](apsl_result result) {
        CHECK(result == APSL_ERROR_INVALID_ARGUMENT);
        CHECK_THAT(apsl_last_error(), Catch::Contains(what));
        CHECK(event == nullptr);
    };
    const int commands = opencl_calls().commands;
    check_in_c(apsl_limiter_enqueue(in_c, queue, &in_c_views, &parameters, 1, count, wait_list.data(), &event));
    check_in_c(apsl_limiter_enqueue_rest_areas(in_c, queue, &in_c_views.positions, &in_c_views.rest_areas, count,
                                               wait_list.data(), &event));
    check_in_c(apsl_limiter_read_stats(in_c, queue, &c_stats, 1, count, wait_list.data(), &event));
    CHECK(opencl_calls().commands == commands);
    CHECK(opencl_calls().reads == reads);
    CHECK(same_bytes(buffers.read_velocities(), CallerBuffers({&cloth(), 1}, {}).read_velocities()));
}

struct InC {
    apsl_topology* topology = nullptr;
    apsl_limiter* limiter = nullptr;
    InC(cl_context context, cl_device_id device) {
        const auto triangles = cloth().topology->triangles();
        REQUIRE(apsl_topology_create(triangles.data()->data(), triangles.size(), cloth().topology->vertex_count(),
                                     &topology) == APSL_SUCCESS);
        REQUIRE(apsl_limiter_create(context, device, &topology, 1, nullptr, &limiter) == APSL_SUCCESS);
    }
    InC(const InC&) = delete;
    InC& operator=(const InC&) = delete;
    ~InC() {
        apsl_limiter_destroy(limiter);
        apsl_topology_destroy(topology);
    }
};

}  // namespace

TEST_CASE("queues and events of another context are refused, and null ones", "[embed]") {
    StrainLimiter made = limiter();
    const InC in_c(device().context, device().id);
    const OtherContext other;
    const Owned<cl_command_queue> queue = in_order_queue();
    cl_int status = CL_SUCCESS;
    const Owned<cl_event> event(clCreateUserEvent(device().context, &status), clReleaseEvent);
    require_success(status, "clCreateUserEvent");
    check_refused(made, in_c.limiter, "queue is null", nullptr, {});
    check_refused(made, in_c.limiter, "queue is of another context", other.queue.get(), {});
    check_refused(made, in_c.limiter, "wait_list[0] is null", queue.get(), {nullptr});
    check_refused(made, in_c.limiter, "wait_list[1] is null", queue.get(), {event.get(), nullptr});
    check_refused(made, in_c.limiter, "wait_list[1] is of another context", queue.get(),
                  {event.get(), other.event.get()});
}

// Run where there are two devices (CMakeLists.txt).
TEST_CASE("a queue on another device of the context, and a device of another context, are refused", "[.two_devices]") {
    cl_platform_id platform = nullptr;
    require_success(clGetDeviceInfo(device().id, CL_DEVICE_PLATFORM, sizeof platform, &platform, nullptr),
                    "clGetDeviceInfo");
    cl_device_id devices[2]{};
    cl_uint count = 0;
    require_success(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 2, devices, &count), "clGetDeviceIDs");
    REQUIRE(count >= 2);
    cl_int status = CL_SUCCESS;
    const Owned<cl_context> both(clCreateContext(nullptr, 2, devices, nullptr, nullptr, &status), clReleaseContext);
    require_success(status, "clCreateContext");
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}}) {
        StrainLimiter made(both.get(), devices[n], cloth().topology);
        const InC in_c(both.get(), devices[n]);
        const Owned<cl_command_queue> queue(clCreateCommandQueue(both.get(), devices[1 - n], 0, &status),
                                            clReleaseCommandQueue);
        require_success(status, "clCreateCommandQueue");
        check_refused(made, in_c.limiter, "queue is on device ", queue.get(), {});
    }
    const cl_device_id other = device().id == devices[0] ? devices[1] : devices[0];
    check_invalid("is not in the context, expected one of its 1",
                  [&] { StrainLimiter(device().context, other, cloth().topology); });
}
