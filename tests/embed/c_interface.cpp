// SPDX-License-Identifier: MIT
#include "embed/c_program.h"
#include "embed/c_views.hpp"
#include "support/device_cloth.hpp"

#include <apsl/tethers.hpp>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <thread>

using namespace apsl;
using namespace apsl::test;

namespace {

struct CTopology {
    apsl_topology* topology = nullptr;
    explicit CTopology(const MovingCloth& cloth) {
        REQUIRE(apsl_topology_create(cloth.topology->triangles().data()->data(), cloth.topology->triangle_count(),
                                     cloth.topology->vertex_count(), &topology) == APSL_SUCCESS);
    }
    ~CTopology() { apsl_topology_destroy(topology); }
};

}  // namespace

TEST_CASE("the C interface does what the C++ one does, byte for byte, in every execution", "[embed]") {
    const MovingCloth cloth = moving_cloth(grid(9, 9, 1.0, 1.0, Diagonals::alternating), 1);
    const Parameters parameters;
    for (const apsl_execution execution :
         {APSL_EXECUTION_AUTOMATIC, APSL_EXECUTION_MANY_GROUPS, APSL_EXECUTION_ONE_GROUP}) {
        CAPTURE(static_cast<int>(execution));
        const Options options{.execution = static_cast<Execution>(execution)};
        const CallerBuffers expected({&cloth, 1}, options), buffers({&cloth, 1}, options);
        StrainLimiter limiter(device().context, device().id, cloth.topology, options);
        const std::vector<Stats> expected_stats = filter(limiter, expected, {&parameters, 1});

        const Owned<cl_command_queue> queue = in_order_queue();
        const apsl_buffers views = c_views(buffers.views());
        apsl_stats stats{};
        std::size_t scratch_bytes = 0;
        REQUIRE(filter_in_c(device().context, device().id, queue.get(), cloth.topology->triangles().data()->data(),
                            cloth.topology->triangle_count(), cloth.topology->vertex_count(), execution, &views, &stats,
                            &scratch_bytes) == APSL_SUCCESS);
        CHECK(same_bytes(buffers.read_velocities(), expected.read_velocities()));
        CHECK(std::memcmp(&stats, expected_stats.data(), sizeof stats) == 0);
        CHECK(stats.sub_steps == parameters.sub_steps);
        CHECK(scratch_bytes == limiter.scratch_bytes());
    }
}

TEST_CASE("the C interface: every error is a result and one line, nothing is thrown", "[embed]") {
    const MovingCloth cloth = moving_cloth(tetrahedron(), 1);
    const CallerBuffers buffers({&cloth, 1}, {});
    const Owned<cl_command_queue> queue = in_order_queue();
    const auto last_error_says = [](const std::string& what) {
        const std::string message = apsl_last_error();
        CAPTURE(message, what);
        CHECK(message.find(what) != std::string::npos);
        CHECK(message.find('\n') == std::string::npos);
    };

    const std::uint32_t bad[] = {0, 1, 9};
    int elsewhere_entirely = 0;  // what a failure must overwrite with null
    apsl_topology* topology = reinterpret_cast<apsl_topology*>(&elsewhere_entirely);
    CHECK(apsl_topology_create(bad, 1, 3, &topology) == APSL_ERROR_INVALID_MESH);
    CHECK(topology == nullptr);
    last_error_says("9");
    CHECK(apsl_topology_create(nullptr, 1, 3, &topology) == APSL_ERROR_INVALID_ARGUMENT);
    last_error_says("triangles is null");
    CHECK(apsl_topology_create(bad, 1, 3, nullptr) == APSL_ERROR_INVALID_ARGUMENT);
    CHECK(apsl_topology_create(nullptr, 0, 3, &topology) == APSL_ERROR_INVALID_MESH);
    last_error_says("the mesh has no triangles");
    // Corners are numbered in 32 bits: refused before one is read.
    for (const std::size_t count : {std::size_t{1431655766}, std::size_t{1} << 32, SIZE_MAX}) {
        CHECK(apsl_topology_create(bad, count, 3, &topology) == APSL_ERROR_INVALID_MESH);
        last_error_says("the mesh has " + std::to_string(count) + " triangles, expected at most 1431655765");
        CHECK(topology == nullptr);
    }
    CHECK(apsl_topology_create(bad, 1, std::size_t{1} << 32, &topology) == APSL_ERROR_INVALID_MESH);
    last_error_says("the mesh has 4294967296 vertices, expected at most 4294967295");

    const CTopology good(cloth);
    const apsl_topology* const cloths[] = {good.topology, nullptr};
    apsl_limiter* limiter = reinterpret_cast<apsl_limiter*>(&elsewhere_entirely);
    apsl_options options = apsl_default_options();
    options.position_stride = 1;
    CHECK(apsl_limiter_create(device().context, device().id, cloths, 1, &options, &limiter) ==
          APSL_ERROR_INVALID_ARGUMENT);
    CHECK(limiter == nullptr);
    last_error_says("position_stride is 1");
    options = apsl_default_options();
    options.execution = 3;
    CHECK(apsl_limiter_create(device().context, device().id, cloths, 1, &options, &limiter) ==
          APSL_ERROR_INVALID_ARGUMENT);
    CHECK(limiter == nullptr);
    last_error_says("execution");
    options.execution = APSL_EXECUTION_ONE_GROUP;
    options.matrix = APSL_MATRIX_PRINTED;
    CHECK(apsl_limiter_create(device().context, device().id, cloths, 1, &options, &limiter) ==
          APSL_ERROR_INVALID_ARGUMENT);
    last_error_says("one_group");
    CHECK(apsl_limiter_create(device().context, device().id, cloths, 2, nullptr, &limiter) ==
          APSL_ERROR_INVALID_ARGUMENT);
    last_error_says("topology is null");
    CHECK(apsl_limiter_create(nullptr, device().id, cloths, 1, nullptr, &limiter) == APSL_ERROR_INVALID_ARGUMENT);
    last_error_says("context is null");
    CHECK(apsl_limiter_scratch_bytes(nullptr) == 0);
    REQUIRE(apsl_limiter_create(device().context, device().id, cloths, 1, nullptr, &limiter) == APSL_SUCCESS);

    const apsl_buffers views = c_views(buffers.views());
    apsl_parameters parameters = apsl_default_parameters();
    parameters.regularization = 0.5f;
    cl_event event = nullptr;
    CHECK(apsl_limiter_enqueue(limiter, queue.get(), &views, &parameters, 1, 0, nullptr, &event) ==
          APSL_ERROR_INVALID_ARGUMENT);
    CHECK(event == nullptr);
    last_error_says("regularization is 0.5");
    parameters = apsl_default_parameters();
    CHECK(apsl_limiter_enqueue(limiter, queue.get(), nullptr, &parameters, 1, 0, nullptr, &event) ==
          APSL_ERROR_INVALID_ARGUMENT);
    CHECK(apsl_limiter_enqueue(nullptr, queue.get(), &views, &parameters, 1, 0, nullptr, &event) ==
          APSL_ERROR_INVALID_ARGUMENT);
    CHECK(apsl_limiter_enqueue(limiter, queue.get(), &views, nullptr, 1, 0, nullptr, &event) ==
          APSL_ERROR_INVALID_ARGUMENT);
    CHECK(apsl_limiter_enqueue(limiter, queue.get(), &views, &parameters, 1, 1, nullptr, &event) ==
          APSL_ERROR_INVALID_ARGUMENT);
    last_error_says("wait_list is null");
    for (const size_t count : {size_t{3}, SIZE_MAX}) {  // of which only one is there
        CHECK(apsl_limiter_enqueue(limiter, queue.get(), &views, &parameters, count, 0, nullptr, &event) ==
              APSL_ERROR_INVALID_ARGUMENT);
        last_error_says("parameters given for 1 cloths, expected one for each or a single one");
    }
    apsl_stats stats{};
    CHECK(apsl_limiter_read_stats(limiter, queue.get(), &stats, 1, 0, nullptr, nullptr) == APSL_ERROR_INVALID_ARGUMENT);
    last_error_says("event is null");

    // The message is this thread's own.
    std::string elsewhere = "not asked";
    std::thread([&] { elsewhere = apsl_last_error(); }).join();
    CHECK(elsewhere.empty());
    last_error_says("event is null");

    // An event nobody wants is released; the call happens all the same.
    CHECK(apsl_limiter_enqueue(limiter, queue.get(), &views, &parameters, 1, 0, nullptr, nullptr) == APSL_SUCCESS);
    require_success(clFinish(queue.get()), "clFinish");
    CHECK_FALSE(same_bytes(buffers.read_velocities(), CallerBuffers({&cloth, 1}, {}).read_velocities()));
    apsl_limiter_destroy(limiter);
    apsl_limiter_destroy(nullptr);
    apsl_topology_destroy(nullptr);
}

namespace {

/// One call of the C interface on an in-order queue, waited for.
apsl_stats filter_in_c(apsl_limiter* limiter, const apsl_buffers& views, const apsl_parameters& parameters) {
    const Owned<cl_command_queue> queue = in_order_queue();
    apsl_stats stats{};
    cl_event read = nullptr;
    REQUIRE(apsl_limiter_enqueue(limiter, queue.get(), &views, &parameters, 1, 0, nullptr, nullptr) == APSL_SUCCESS);
    REQUIRE(apsl_limiter_read_stats(limiter, queue.get(), &stats, 1, 0, nullptr, &read) == APSL_SUCCESS);
    require_success(wait_and_release(read), "reading the statistics");
    return stats;
}

}  // namespace

TEST_CASE("the C interface: rest areas from positions, a cloth off, scratch memory, a rebuild", "[embed]") {
    const MovingCloth cloth = moving_cloth(grid(9, 9, 1.0, 1.0, Diagonals::alternating), 1);
    const MovingCloth other = moving_cloth(grid(7, 9, 1.0, 1.0, Diagonals::alternating), 2);
    const CTopology topology(cloth), other_topology(other);
    const apsl_topology* const cloths[] = {topology.topology};
    const apsl_topology* const others[] = {other_topology.topology};
    const Parameters defaults;

    std::size_t needed = 1;
    CHECK(apsl_limiter_required_scratch_bytes(device().id, cloths, 1, nullptr, nullptr) == APSL_ERROR_INVALID_ARGUMENT);
    CHECK(apsl_limiter_required_scratch_bytes(device().id, cloths, 0, nullptr, &needed) == APSL_ERROR_INVALID_ARGUMENT);
    CHECK(needed == 0);
    REQUIRE(apsl_limiter_required_scratch_bytes(device().id, cloths, 1, nullptr, &needed) == APSL_SUCCESS);
    CHECK(needed == StrainLimiter::required_scratch_bytes(device().id, {&cloth.topology, 1}));
    cl_int status = CL_SUCCESS;
    const Owned<cl_mem> memory(clCreateBuffer(device().context, CL_MEM_READ_WRITE, needed, nullptr, &status),
                               clReleaseMemObject);
    require_success(status, "clCreateBuffer");
    const apsl_buffer_view scratch{memory.get(), 0}, too_small{memory.get(), needed / 2}, nowhere{nullptr, 0};
    apsl_limiter* limiter = nullptr;
    for (const apsl_buffer_view* bad : {&too_small, &nowhere, static_cast<const apsl_buffer_view*>(nullptr)}) {
        CHECK(apsl_limiter_create_in_scratch(device().context, device().id, cloths, 1, nullptr, nullptr, 0, bad,
                                             &limiter) == APSL_ERROR_INVALID_ARGUMENT);
        CHECK(limiter == nullptr);
        CHECK(std::string(apsl_last_error()).starts_with("scratch"));
    }
    REQUIRE(apsl_limiter_create_in_scratch(device().context, device().id, cloths, 1, nullptr, nullptr, 0, &scratch,
                                           &limiter) == APSL_SUCCESS);

    // Off: nothing moves.
    const CallerBuffers buffers({&cloth, 1}, {}), expected({&cloth, 1}, {});
    apsl_parameters parameters = apsl_default_parameters();
    CHECK(parameters.enabled == 1);
    parameters.enabled = 0;
    CHECK(filter_in_c(limiter, c_views(buffers.views()), parameters).status == APSL_STATUS_OFF);
    CHECK(same_bytes(buffers.read_velocities(), expected.read_velocities()));
    parameters.enabled = 1;
    StrainLimiter same(device().context, device().id, cloth.topology);
    const std::vector<Stats> expected_stats = filter(same, expected, {&defaults, 1});
    const apsl_stats stats = filter_in_c(limiter, c_views(buffers.views()), parameters);
    CHECK(std::memcmp(&stats, expected_stats.data(), sizeof stats) == 0);
    CHECK(same_bytes(buffers.read_velocities(), expected.read_velocities()));

    // At rest where it lies: x̃ as rest positions, and no velocities.
    const Owned<cl_command_queue> queue = in_order_queue();
    apsl_buffers views = c_views(buffers.views());
    MovingCloth still = cloth;
    still.velocities.assign(still.velocities.size(), 0.0);
    const CallerBuffers at_rest({&still, 1}, {});
    views.velocities = c_views(at_rest.views()).velocities;
    cl_event measured = nullptr;
    CHECK(apsl_limiter_enqueue_rest_areas(limiter, queue.get(), nullptr, &views.rest_areas, 0, nullptr, &measured) ==
          APSL_ERROR_INVALID_ARGUMENT);
    REQUIRE(apsl_limiter_enqueue_rest_areas(limiter, queue.get(), &views.positions, &views.rest_areas, 0, nullptr,
                                            &measured) == APSL_SUCCESS);
    require_success(wait_and_release(measured), "the rest areas");
    parameters.sub_steps = 0;
    CHECK(filter_in_c(limiter, views, parameters).initial_max_area_change < 1e-6f);

    CHECK(apsl_limiter_rebuild(limiter, nullptr, 1, nullptr) == APSL_ERROR_INVALID_ARGUMENT);
    CHECK(apsl_limiter_rebuild(nullptr, others, 1, nullptr) == APSL_ERROR_INVALID_ARGUMENT);
    REQUIRE(apsl_limiter_rebuild(limiter, others, 1, nullptr) == APSL_SUCCESS);
    const CallerBuffers other_buffers({&other, 1}, {}), other_expected({&other, 1}, {});
    StrainLimiter fresh(device().context, device().id, other.topology);
    filter(fresh, other_expected, {&defaults, 1});
    CHECK(filter_in_c(limiter, c_views(other_buffers.views()), apsl_default_parameters()).status == APSL_STATUS_OK);
    CHECK(same_bytes(other_buffers.read_velocities(), other_expected.read_velocities()));
    CHECK(apsl_limiter_scratch_bytes(limiter) == fresh.scratch_bytes());
    apsl_limiter_destroy(limiter);
}

TEST_CASE("the C interface's defaults are the C++ ones", "[embed]") {
    const apsl_options o = apsl_default_options();
    const Options options;
    CHECK(o.matrix == static_cast<int>(options.matrix));
    CHECK(o.apply == static_cast<int>(options.apply));
    CHECK(o.execution == static_cast<int>(options.execution));
    CHECK(o.work_group_size == options.work_group_size);
    CHECK(o.position_stride == options.position_stride);
    CHECK(o.velocity_stride == options.velocity_stride);
    CHECK(o.position_component_stride == options.position_component_stride);
    CHECK(o.velocity_component_stride == options.velocity_component_stride);
    CHECK(o.inverse_mass_stride == options.inverse_mass_stride);
    CHECK(o.positions_only == 0);
    CHECK(o.regularization_per_triangle == 0);
    CHECK(o.warm_start_sub_steps == options.warm_start_sub_steps);
    CHECK(o.solver == static_cast<int>(options.solver));
    CHECK(o.bound_interval == options.bound_interval);
    CHECK(o.limits_stretch == 0);
    CHECK(o.stretch_ceiling_per_triangle == 0);
    CHECK(o.integrates == 0);
    CHECK(o.bends == 0);
    CHECK(o.acceleration_per_vertex == 0);
    CHECK(o.keeps_contacts == 0);
    CHECK(o.tethers_per_vertex == 0);
    const apsl_parameters p = apsl_default_parameters();
    const Parameters parameters;
    CHECK(p.time_step == parameters.time_step);
    CHECK(p.regularization == parameters.regularization);
    CHECK(p.sub_steps == parameters.sub_steps);
    CHECK(p.target_area_change == parameters.target_area_change);
    CHECK(p.tolerance == parameters.tolerance);
    CHECK(p.max_iterations == parameters.max_iterations);
    CHECK(p.adaptive_threshold == parameters.adaptive_threshold);
    CHECK(p.first_regularization == parameters.first_regularization);
    CHECK(p.stretch_ceiling == parameters.stretch_ceiling);
    CHECK(p.most_sub_steps == parameters.most_sub_steps);
    CHECK(std::equal(p.acceleration, p.acceleration + 3, parameters.acceleration.begin()));
    CHECK(p.damping == parameters.damping);
    CHECK(p.stepping == static_cast<int>(parameters.stepping));
    CHECK(p.enabled == 1);
    CHECK(p.bending == parameters.bending);
    CHECK(p.bending_iterations == parameters.bending_iterations);
    for (const std::uint32_t word : o.reserved) CHECK(word == 0);
    for (const std::uint32_t word : p.reserved) CHECK(word == 0);
}

TEST_CASE("a whole step by the C interface leaves the bytes of the C++ one", "[embed]") {
    const MovingCloth cloth = moving_cloth(grid(9, 7, 1.0, 1.0, Diagonals::alternating), 1);
    const CTopology topology(cloth);
    apsl_options c_options = apsl_default_options();
    c_options.integrates = 1;
    c_options.keeps_contacts = 1;
    c_options.limits_stretch = 1;
    c_options.acceleration_per_vertex = 1;
    apsl_parameters c_parameters = apsl_default_parameters();
    c_parameters.sub_steps = 4;
    c_parameters.most_sub_steps = 6;
    c_parameters.stretch_ceiling = 1.05f;
    c_parameters.acceleration[1] = -9.81f;
    c_parameters.damping = 0.5f;
    const Options options{
        .limits_stretch = true, .integrates = true, .keeps_contacts = true, .acceleration_per_vertex = true};
    const Parameters parameters{.sub_steps = 4,
                                .most_sub_steps = 6,
                                .stretch_ceiling = 1.05f,
                                .acceleration = {0.0f, -9.81f, 0.0f},
                                .damping = 0.5f};

    apsl_limiter* limiter = nullptr;
    REQUIRE(apsl_limiter_create(device().context, device().id, &topology.topology, 1, &c_options, &limiter) ==
            APSL_SUCCESS);
    const CallerBuffers by_c({&cloth, 1}, options), by_cpp({&cloth, 1}, options);
    const apsl_buffers views = c_views(by_c.views());
    const Owned<cl_command_queue> queue = in_order_queue();
    REQUIRE(apsl_limiter_enqueue(limiter, queue.get(), &views, &c_parameters, 1, 0, nullptr, nullptr) == APSL_SUCCESS);
    clFinish(queue.get());
    apsl_limiter_destroy(limiter);
    StrainLimiter cpp(device().context, device().id, cloth.topology, options);
    filter(cpp, by_cpp, {&parameters, 1});
    CHECK(by_c.read_positions() == by_cpp.read_positions());
    CHECK(by_c.read_velocities() == by_cpp.read_velocities());
    CHECK(by_c.read_positions() != CallerBuffers({&cloth, 1}, options).read_positions());
}

TEST_CASE("tethers by the C interface are the C++ ones, and a step with them leaves the same bytes", "[embed]") {
    const Mesh mesh = grid(9, 7, 1.0, 1.0, Diagonals::alternating);
    const MovingCloth cloth = moving_cloth(mesh, 1);
    const CTopology topology(cloth);
    const std::vector<float> rest_positions(mesh.positions.begin(), mesh.positions.end());
    const std::vector<std::uint32_t> pinned{31, 0};  // moving_cloth's pins
    constexpr std::uint32_t per_vertex = 2;
    const Tethers tethers = tethers_to_pins(*cloth.topology, rest_positions, pinned, per_vertex, 0.75f);

    std::size_t pieces = 9;
    REQUIRE(apsl_pinned_piece_count(topology.topology, pinned.data(), pinned.size(), &pieces) == APSL_SUCCESS);
    CHECK(pieces == 2);
    REQUIRE(apsl_pinned_piece_count(topology.topology, nullptr, 0, &pieces) == APSL_SUCCESS);
    CHECK(pieces == 0);
    std::vector<std::uint32_t> anchors = poison<std::uint32_t>(tethers.anchors.size() + 1);
    std::vector<float> lengths = poison<float>(tethers.lengths.size() + 1);
    REQUIRE(apsl_tethers_to_pins(topology.topology, rest_positions.data(), pinned.data(), pinned.size(), per_vertex,
                                 0.75f, anchors.data(), lengths.data()) == APSL_SUCCESS);
    CHECK(anchors.back() == poison<std::uint32_t>(1)[0]);
    CHECK(std::isnan(lengths.back()));
    anchors.pop_back();
    lengths.pop_back();
    CHECK(anchors == tethers.anchors);
    CHECK(lengths == tethers.lengths);
    // One of two steps of 1/8 m from the first pin along its edge: 0.75 of that.
    CHECK(anchors[per_vertex * 1] == 0);
    CHECK(lengths[per_vertex * 1] == 0.75f * 0.125f);

    apsl_options c_options = apsl_default_options();
    c_options.integrates = 1;
    c_options.tethers_per_vertex = per_vertex;
    const Options options{.integrates = true, .tethers_per_vertex = per_vertex};
    apsl_limiter* limiter = nullptr;
    REQUIRE(apsl_limiter_create(device().context, device().id, &topology.topology, 1, &c_options, &limiter) ==
            APSL_SUCCESS);
    // The lengths of the C views begin behind a number that is none of theirs.
    std::vector<float> behind{100.0f};
    behind.insert(behind.end(), lengths.begin(), lengths.end());
    const DeviceArray<std::uint32_t> device_anchors(anchors);
    const DeviceArray<float> device_lengths(lengths), lengths_behind(behind);
    const CallerBuffers by_c({&cloth, 1}, options), by_cpp({&cloth, 1}, options), without({&cloth, 1}, options);
    Buffers cpp_views = by_cpp.views(), untethered = by_c.views();
    cpp_views.tether_anchors = {device_anchors.get()};
    cpp_views.tether_lengths = {device_lengths.get()};
    untethered.tether_anchors = untethered.tether_lengths = {};
    const apsl_parameters c_parameters = apsl_default_parameters();
    const Owned<cl_command_queue> queue = in_order_queue();
    const apsl_buffers nothing = c_views(untethered);
    CHECK(apsl_limiter_enqueue(limiter, queue.get(), &nothing, &c_parameters, 1, 0, nullptr, nullptr) ==
          APSL_ERROR_INVALID_ARGUMENT);
    CHECK(std::string(apsl_last_error()).find("buffers.tether_anchors") != std::string::npos);
    untethered.tether_anchors = cpp_views.tether_anchors;
    untethered.tether_lengths = {lengths_behind.get(), sizeof(float)};
    const apsl_buffers views = c_views(untethered);
    REQUIRE(apsl_limiter_enqueue(limiter, queue.get(), &views, &c_parameters, 1, 0, nullptr, nullptr) == APSL_SUCCESS);
    StrainLimiter cpp(device().context, device().id, cloth.topology, options);
    require_success(wait_and_release(cpp.enqueue(queue.get(), cpp_views, Parameters{})), "the step");
    apsl_limiter_destroy(limiter);
    CHECK(same_bytes(by_c.read_positions(), by_cpp.read_positions()));
    CHECK(same_bytes(by_c.read_velocities(), by_cpp.read_velocities()));

    StrainLimiter free(device().context, device().id, cloth.topology, {.integrates = true});
    Buffers free_views = without.views();
    free_views.tether_anchors = free_views.tether_lengths = {};
    require_success(wait_and_release(free.enqueue(queue.get(), free_views, Parameters{})), "the step");
    CHECK_FALSE(same_bytes(by_c.read_positions(), without.read_positions()));
}

TEST_CASE("the C interface: what tethers cannot be made of is refused, and nothing is written", "[embed]") {
    const Mesh mesh = grid(3, 3, 1.0, 1.0, Diagonals::alternating);
    const CTopology topology(moving_cloth(mesh, 1));
    std::vector<float> rest_positions(mesh.positions.begin(), mesh.positions.end());
    const std::vector<std::uint32_t> pinned{0, 9};
    std::vector<std::uint32_t> anchors = poison<std::uint32_t>(mesh.vertex_count());
    std::vector<float> lengths = poison<float>(mesh.vertex_count());
    const auto refused = [&](const std::string& line, const apsl_topology* of, const float* positions,
                             const std::uint32_t* pins, std::uint32_t per_vertex, float stretch,
                             std::uint32_t* to_anchors, float* to_lengths) {
        CHECK(apsl_tethers_to_pins(of, positions, pins, 1, per_vertex, stretch, to_anchors, to_lengths) ==
              APSL_ERROR_INVALID_ARGUMENT);
        CAPTURE(line, apsl_last_error());
        CHECK(std::string(apsl_last_error()).find(line) != std::string::npos);
        CHECK(same_bytes(anchors, poison<std::uint32_t>(anchors.size())));
        CHECK(same_bytes(lengths, poison<float>(lengths.size())));
    };
    const float* const x = rest_positions.data();
    const std::uint32_t *const good = pinned.data(), *const bad = pinned.data() + 1;
    std::uint32_t* const a = anchors.data();
    float* const l = lengths.data();
    refused("topology is null", nullptr, x, good, 1, 1.0f, a, l);
    refused("rest_positions is null", topology.topology, nullptr, good, 1, 1.0f, a, l);
    refused("pinned is null", topology.topology, x, nullptr, 1, 1.0f, a, l);
    refused("anchors is null", topology.topology, x, good, 1, 1.0f, nullptr, l);
    refused("lengths is null", topology.topology, x, good, 1, 1.0f, a, nullptr);
    refused("pinned vertex 9, expected one below 9", topology.topology, x, bad, 1, 1.0f, a, l);
    refused("per_vertex is 0", topology.topology, x, good, 0, 1.0f, a, l);
    for (const float stretch : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()})
        refused("stretch is", topology.topology, x, good, 1, stretch, a, l);
    rest_positions[4] = std::numeric_limits<float>::infinity();
    refused("rest_positions of vertex 1 is not finite", topology.topology, x, good, 1, 1.0f, a, l);

    std::size_t pieces = 7;
    CHECK(apsl_pinned_piece_count(topology.topology, bad, 1, &pieces) == APSL_ERROR_INVALID_ARGUMENT);
    CHECK(pieces == 0);
    pieces = 7;
    CHECK(apsl_pinned_piece_count(nullptr, good, 1, &pieces) == APSL_ERROR_INVALID_ARGUMENT);
    CHECK(pieces == 0);
    CHECK(apsl_pinned_piece_count(topology.topology, nullptr, 1, &pieces) == APSL_ERROR_INVALID_ARGUMENT);
    CHECK(apsl_pinned_piece_count(topology.topology, good, 1, nullptr) == APSL_ERROR_INVALID_ARGUMENT);

    apsl_options options = apsl_default_options();
    apsl_limiter* limiter = nullptr;
    const auto refused_options = [&](const std::string& line) {
        CHECK(apsl_limiter_create(device().context, device().id, &topology.topology, 1, &options, &limiter) ==
              APSL_ERROR_INVALID_ARGUMENT);
        CAPTURE(line, apsl_last_error());
        CHECK(std::string(apsl_last_error()).find(line) != std::string::npos);
    };
    options.tethers_per_vertex = 1;
    refused_options("tethers_per_vertex is 1, which needs integrates");
    options.integrates = 1;
    options.tethers_per_vertex = 5;
    refused_options("tethers_per_vertex is 5, expected a whole number >= 0 and <= 4");
}

TEST_CASE("what is reserved in C structs is refused unless zero", "[embed]") {
    const MovingCloth cloth = moving_cloth(grid(3, 3, 1.0, 1.0, Diagonals::alternating), 1);
    const CTopology topology(cloth);
    apsl_options options = apsl_default_options();
    options.reserved[3] = 5;
    apsl_limiter* limiter = nullptr;
    CHECK(apsl_limiter_create(device().context, device().id, &topology.topology, 1, &options, &limiter) ==
          APSL_ERROR_INVALID_ARGUMENT);
    CHECK(limiter == nullptr);
    CHECK(std::string(apsl_last_error())
              .find("options.reserved holds 5, expected zeros: begin with apsl_default_options()") !=
          std::string::npos);

    REQUIRE(apsl_limiter_create(device().context, device().id, &topology.topology, 1, nullptr, &limiter) ==
            APSL_SUCCESS);
    const CallerBuffers buffers({&cloth, 1}, {});
    const apsl_buffers views = c_views(buffers.views());
    const Owned<cl_command_queue> queue = in_order_queue();
    apsl_parameters parameters = apsl_default_parameters();
    parameters.reserved[0] = 1;
    CHECK(apsl_limiter_enqueue(limiter, queue.get(), &views, &parameters, 1, 0, nullptr, nullptr) ==
          APSL_ERROR_INVALID_ARGUMENT);
    CHECK(std::string(apsl_last_error())
              .find("parameters.reserved holds 1, expected zeros: begin with apsl_default_parameters()") !=
          std::string::npos);
    apsl_limiter_destroy(limiter);
}
