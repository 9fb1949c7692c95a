// SPDX-License-Identifier: MIT
//
// What a call writes shares no float with anything else that it uses, whichever buffers and sub-buffers name them.
#include "host/overlaps.hpp"

#include "embed/refusals.hpp"
#include "embed/small_limiter.hpp"
#include "kernels/constants.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <set>
#include <string>

using namespace apsl;
using namespace apsl::test;

namespace {

Owned<cl_mem> memory(std::size_t bytes) {
    cl_int status = CL_SUCCESS;
    Owned<cl_mem> made(clCreateBuffer(device().context, CL_MEM_READ_WRITE, bytes, nullptr, &status),
                       clReleaseMemObject);
    require_success(status, "clCreateBuffer");
    const cl_float zero = 0.0f;
    const Owned<cl_command_queue> queue = in_order_queue();
    require_success(clEnqueueFillBuffer(queue.get(), made.get(), &zero, sizeof zero, 0, bytes, 0, nullptr, nullptr),
                    "clEnqueueFillBuffer");
    require_success(clFinish(queue.get()), "clFinish");
    return made;
}

Owned<cl_mem> part_of(const Owned<cl_mem>& buffer, std::size_t origin, std::size_t bytes) {
    cl_int status = CL_SUCCESS;
    const cl_buffer_region region{origin, bytes};
    Owned<cl_mem> made(
        clCreateSubBuffer(buffer.get(), CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region, &status),
        clReleaseMemObject);
    require_success(status, "clCreateSubBuffer");
    return made;
}

void enqueue(StrainLimiter& made, const Buffers& buffers, const Parameters& parameters = {.sub_steps = 2}) {
    const Owned<cl_command_queue> queue = in_order_queue();
    require_success(wait_and_release(made.enqueue(queue.get(), buffers, parameters)), "the call");
}

struct View {
    const char* name;
    BufferView Buffers::* field;
    std::size_t floats;
};

constexpr Options whole_step{.limits_stretch = true,
                             .stretch_ceiling_per_triangle = true,
                             .integrates = true,
                             .keeps_contacts = true,
                             .bends = true,
                             .acceleration_per_vertex = true,
                             .tethers_per_vertex = 2};

// Of whole_step.
std::vector<View> views() {
    const std::size_t vertices = cloth().topology->vertex_count(), triangles = cloth().topology->triangle_count();
    return {{"buffers.positions", &Buffers::positions, 3 * vertices},
            {"buffers.velocities", &Buffers::velocities, 3 * vertices},
            {"buffers.inverse_masses", &Buffers::inverse_masses, vertices},
            {"buffers.rest_areas", &Buffers::rest_areas, triangles},
            {"buffers.rest_shapes", &Buffers::rest_shapes, 4 * triangles},
            {"buffers.rest_hinges", &Buffers::rest_hinges, 2 * cloth().topology->hinges().size()},
            {"buffers.stretch_ceilings", &Buffers::stretch_ceilings, triangles},
            {"buffers.contacts", &Buffers::contacts, APSLK_CONTACT_SIZE * vertices},
            {"buffers.accelerations", &Buffers::accelerations, 3 * vertices},
            {"buffers.tether_anchors", &Buffers::tether_anchors, 2 * vertices},
            {"buffers.tether_lengths", &Buffers::tether_lengths, 2 * vertices}};
}

}  // namespace

TEST_CASE("a whole step refuses anything that shares a float with positions or velocities", "[embed]") {
    constexpr std::size_t room = 1024;  // floats, enough for any of them
    const std::vector<View> all = views();
    const Owned<cl_mem> one = memory(4 * room * (all.size() + 1));
    Buffers apart;
    for (std::size_t n = 0; n < all.size(); ++n) {
        REQUIRE(all[n].floats <= room);
        apart.*all[n].field = {one.get(), 4 * room * (n + 1)};
    }
    StrainLimiter made = limiter(whole_step);
    CHECK_NOTHROW(enqueue(made, apart));
    for (std::size_t written = 0; written < 2; ++written)
        for (std::size_t n = written + 1; n < all.size(); ++n) {
            const std::size_t begin = (apart.*all[written].field).offset, end = begin + 4 * all[written].floats;
            const std::string both = std::string(all[n].name) + " overlaps " + all[written].name + ": both have byte ";
            const std::string rest = std::string(" of one buffer, and ") + all[written].name + " is written";
            const auto at = [&](std::size_t offset) {
                return [&, offset] {
                    Buffers given = apart;
                    given.*all[n].field = {one.get(), offset};
                    enqueue(made, given);
                };
            };
            CAPTURE(all[n].name, all[written].name);
            // The first float of one is the last of the other.
            check_invalid(both + std::to_string(end - 4) + rest, at(end - 4));
            check_invalid(both + std::to_string(begin) + rest, at(begin + 4 - 4 * all[n].floats));
            CHECK_NOTHROW(at(end)());
            CHECK_NOTHROW(at(begin - 4 * all[n].floats)());
        }
}

TEST_CASE("what a call only reads may lie in one place", "[embed]") {
    StrainLimiter made = limiter();
    const CallerBuffers buffers({&cloth(), 1}, {}), others({&cloth(), 1}, {});
    Buffers given = buffers.views();
    given.inverse_masses = given.positions;
    given.rest_areas = given.positions;
    CHECK_NOTHROW(enqueue(made, given));
    given.inverse_masses = given.velocities;
    check_invalid("buffers.inverse_masses overlaps buffers.velocities", [&] { enqueue(made, given); });
    StrainLimiter of_positions = limiter({.positions_only = true});
    given = others.views();
    given.velocities = {};
    CHECK_NOTHROW(enqueue(of_positions, given));
    given.rest_areas = given.positions;
    check_invalid("buffers.rest_areas overlaps buffers.positions", [&] { enqueue(of_positions, given); });
}

TEST_CASE("a buffer and its sub-buffers are one memory", "[embed]") {
    constexpr std::size_t origin = 4096;  // a multiple of any device's alignment
    const std::size_t bytes = 12 * cloth().topology->vertex_count();
    const Owned<cl_mem> whole = memory(4 * origin);
    const Owned<cl_mem> first = part_of(whole, 0, 2 * origin), second = part_of(whole, origin, origin);
    const CallerBuffers others({&cloth(), 1}, {});
    StrainLimiter made = limiter();
    const auto with = [&](const BufferView& positions, const BufferView& velocities) {
        return [&, positions, velocities] {
            Buffers given = others.views();
            given.positions = positions;
            given.velocities = velocities;
            enqueue(made, given);
        };
    };
    const std::string overlap = "buffers.velocities overlaps buffers.positions: both have byte 4096 of one buffer";
    check_invalid(overlap, with({whole.get(), origin}, {second.get()}));
    check_invalid(overlap, with({second.get()}, {whole.get(), origin}));
    check_invalid(overlap, with({first.get(), origin}, {second.get()}));
    check_invalid(overlap, with({whole.get(), origin + 4 - bytes}, {second.get()}));
    CHECK_NOTHROW(with({whole.get(), origin - bytes}, {second.get()})());
    CHECK_NOTHROW(with({first.get(), origin - bytes}, {second.get()})());
    CHECK_NOTHROW(with({first.get(), origin + bytes}, {second.get()})());
    CHECK_NOTHROW(with({second.get()}, {whole.get()})());
}

TEST_CASE("nothing that a call uses lies in the limiter's own scratch memory", "[embed]") {
    const std::size_t needed = StrainLimiter::required_scratch_bytes(device().id, {&cloth().topology, 1});
    const std::size_t room = 16384;  // a multiple of any device's alignment
    const Owned<cl_mem> one = memory(room + needed + room);
    const Owned<cl_command_queue> queue = in_order_queue();
    StrainLimiter made = limiter({}, {one.get(), room});
    const CallerBuffers buffers({&cloth(), 1}, {});
    const auto with = [&](BufferView Buffers::* field, std::size_t offset) {
        return [&, field, offset] {
            Buffers given = buffers.views();
            given.*field = {one.get(), offset};
            enqueue(made, given);
        };
    };
    const std::size_t bytes = 12 * cloth().topology->vertex_count();
    for (const auto field : {&Buffers::positions, &Buffers::velocities}) {
        CHECK_NOTHROW(with(field, room - bytes)());
        check_invalid("overlaps the limiter's scratch memory", with(field, room + 4 - bytes));
        check_invalid("overlaps the limiter's scratch memory", with(field, room));
        CHECK_NOTHROW(with(field, room + needed)());
    }
    const std::string scratch =
        " overlaps the limiter's scratch memory: both have byte 16384 of one buffer, and the limiter's scratch memory "
        "is written";
    check_invalid("buffers.inverse_masses" + scratch, with(&Buffers::inverse_masses, room));
    check_invalid("buffers.rest_areas" + scratch, with(&Buffers::rest_areas, room));
    const Buffers views = buffers.views();
    check_invalid("rest_areas" + scratch,
                  [&] { clReleaseEvent(made.enqueue_rest_areas(queue.get(), views.positions, {one.get(), room})); });
    const Parameters parameters;
    CHECK(filter(made, CallerBuffers({&cloth(), 1}, {}), {&parameters, 1})[0].status == Status::ok);
}

TEST_CASE("what is computed from rest positions does not lie among them", "[embed]") {
    const Options options{.position_stride = 4, .limits_stretch = true};
    StrainLimiter made = limiter(options);
    const Owned<cl_mem> one = memory(8192);
    const Owned<cl_command_queue> queue = in_order_queue();
    check_invalid("rest_areas overlaps rest_positions: both have byte 0 of one buffer, and rest_areas is written",
                  [&] { clReleaseEvent(made.enqueue_rest_areas(queue.get(), {one.get()}, {one.get()})); });
    const std::size_t last = 16 * (cloth().topology->vertex_count() - 1) + 8;
    check_invalid("rest_shapes overlaps rest_positions: both have byte " + std::to_string(last),
                  [&] { clReleaseEvent(made.enqueue_rest_shapes(queue.get(), {one.get()}, {one.get(), last})); });
    require_success(wait_and_release(made.enqueue_rest_shapes(queue.get(), {one.get()}, {one.get(), last + 4})),
                    "the rest shapes");
}

TEST_CASE("overlaps: as counting every float has them, whatever the strides", "[embed]") {
    const Owned<cl_mem> one = memory(65536);
    std::mt19937 random(7);
    const auto up_to = [&](std::uint32_t most) { return static_cast<std::uint32_t>(random() % (most + 1)); };
    const auto any = [&](const char* name, bool written) {
        return host::FloatsInUse{
            name,        {one.get(), std::size_t{4} * up_to(60)}, written, 1 + up_to(9), 1 + up_to(12), 1 + up_to(2),
            1 + up_to(9)};
    };
    const auto floats = [](const host::FloatsInUse& in_use) {
        std::set<std::size_t> all;
        for (std::size_t n = 0; n < in_use.count; ++n)
            for (std::size_t k = 0; k < in_use.components; ++k)
                all.insert(in_use.view.offset / 4 + n * in_use.stride + k * in_use.component_stride);
        return all;
    };
    int overlaps = 0;
    for (int number = 0; number < 20000; ++number) {
        const host::FloatsInUse in_use[] = {any("a", number % 2 == 0), any("b", number % 2 != 0)};
        const std::set<std::size_t> a = floats(in_use[0]), b = floats(in_use[1]);
        std::vector<std::size_t> both;
        std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
        std::string message;
        try {
            host::MemoryInUse call;
            for (const host::FloatsInUse& floats_in_use : in_use) call.add(floats_in_use);
        } catch (const Error& error) {
            message = error.what();
        }
        CAPTURE(number, message);
        REQUIRE(message.empty() == both.empty());
        if (both.empty()) continue;
        ++overlaps;
        const std::string start = "b overlaps a: both have byte ";
        REQUIRE(message.starts_with(start));
        REQUIRE(std::ranges::find(both, std::stoul(message.substr(start.size())) / 4) != both.end());
    }
    CHECK(overlaps > 2000);
    CHECK(overlaps < 18000);
}
