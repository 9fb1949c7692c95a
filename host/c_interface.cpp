// SPDX-License-Identifier: MIT
#include "caller_objects.hpp"
#include "mesh_size.hpp"

#include <apsl/apsl.h>
#include <apsl/strain_limiter.hpp>
#include <apsl/tethers.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>

struct apsl_topology {
    std::shared_ptr<const apsl::Topology> topology;
};

struct apsl_limiter {
    apsl::StrainLimiter limiter;
};

namespace {

static_assert(sizeof(apsl_stats) == sizeof(apsl::Stats));
static_assert(static_cast<int>(apsl::Status::worsened) == APSL_STATUS_WORSENED);
static_assert(static_cast<int>(apsl::Status::diverged) == APSL_STATUS_DIVERGED);
static_assert(static_cast<int>(apsl::Status::off) == APSL_STATUS_OFF);
static_assert(static_cast<int>(apsl::Offender::triangle) == APSL_OFFENDER_TRIANGLE);
static_assert(static_cast<int>(apsl::Stepping::small_steps) == APSL_STEPPING_SMALL_STEPS);
static_assert(static_cast<int>(apsl::Solver::chebyshev) == APSL_SOLVER_CHEBYSHEV);
static_assert(static_cast<int>(apsl::ErrorCode::unsupported) == APSL_ERROR_UNSUPPORTED);
static_assert(static_cast<int>(apsl::Matrix::printed) == APSL_MATRIX_PRINTED);
static_assert(static_cast<int>(apsl::Apply::matrix_free) == APSL_APPLY_MATRIX_FREE);
static_assert(static_cast<int>(apsl::Execution::many_groups) == APSL_EXECUTION_MANY_GROUPS);
static_assert(static_cast<int>(apsl::Execution::one_group) == APSL_EXECUTION_ONE_GROUP);

static_assert(static_cast<int>(apsl::ProgramBinaryUse::refused_by_driver) == APSL_PROGRAM_BINARY_REFUSED_BY_DRIVER);

// Plain bytes: no memory to run out of, and nothing destroyed ahead of a global object whose destructor calls here.
thread_local std::array<char, 4096> last_error{};

apsl_result fail(apsl_result result, const char* message) noexcept {
    std::size_t size = std::min(std::strlen(message), last_error.size() - 1);
    // Where it is cut short, not within a character of UTF-8.
    while (message[size] != '\0' && size > 0 && (message[size] & 0xC0) == 0x80) --size;
    std::memcpy(last_error.data(), message, size);
    last_error[size] = '\0';
    return result;
}

/// No exception crosses into C.
template <class Action>
apsl_result guarded(const Action& action) noexcept {
    try {
        action();
        return APSL_SUCCESS;
    } catch (const apsl::Error& error) {
        return fail(static_cast<apsl_result>(error.code()), error.what());
    } catch (const std::bad_alloc&) {
        return fail(APSL_ERROR_OUT_OF_MEMORY, "out of host memory");
    } catch (const std::length_error&) {  // a vector's, of more elements than there are addresses
        return fail(APSL_ERROR_OUT_OF_MEMORY, "out of host memory");
    } catch (const std::exception& error) {
        return fail(APSL_ERROR_INTERNAL, error.what());
    } catch (...) {
        return fail(APSL_ERROR_INTERNAL, "unknown error");
    }
}

void require(const void* pointer, const char* name) {
    if (!pointer) throw apsl::Error(apsl::ErrorCode::invalid_argument, std::string(name) + " is null");
}

/// Fields to come mean nothing to this version.
template <class Struct>
void require_reserved_zero(const Struct& given, const char* name) {
    for (const uint32_t word : given.reserved)
        if (word != 0)
            throw apsl::Error(apsl::ErrorCode::invalid_argument,
                              std::string(name) + ".reserved holds " + std::to_string(word) +
                                  ", expected zeros: begin with apsl_default_" + name + "()");
}

std::span<const cl_event> events(cl_uint wait_count, const cl_event* wait_list) {
    if (wait_count > 0) require(wait_list, "wait_list");
    return {wait_list, wait_count};
}

std::span<const uint32_t> pins(const uint32_t* pinned, size_t pinned_count) {
    if (pinned_count > 0) require(pinned, "pinned");
    return {pinned, pinned_count};
}

/// The defaults where there are none.
apsl::Options options_from(const apsl_options* options) {
    const apsl_options o = options ? *options : apsl_default_options();
    require_reserved_zero(o, "options");
    return {.matrix = static_cast<apsl::Matrix>(o.matrix),
            .apply = static_cast<apsl::Apply>(o.apply),
            .execution = static_cast<apsl::Execution>(o.execution),
            .work_group_size = o.work_group_size,
            .position_stride = o.position_stride,
            .velocity_stride = o.velocity_stride,
            .position_component_stride = o.position_component_stride,
            .velocity_component_stride = o.velocity_component_stride,
            .inverse_mass_stride = o.inverse_mass_stride,
            .positions_only = o.positions_only != 0,
            .regularization_per_triangle = o.regularization_per_triangle != 0,
            .warm_start_sub_steps = o.warm_start_sub_steps,
            .solver = static_cast<apsl::Solver>(o.solver),
            .bound_interval = o.bound_interval,
            .limits_stretch = o.limits_stretch != 0,
            .stretch_ceiling_per_triangle = o.stretch_ceiling_per_triangle != 0,
            .integrates = o.integrates != 0,
            .keeps_contacts = o.keeps_contacts != 0,
            .bends = o.bends != 0,
            .acceleration_per_vertex = o.acceleration_per_vertex != 0,
            .tethers_per_vertex = o.tethers_per_vertex};
}

apsl::Parameters parameters_from(const apsl_parameters& p) {
    require_reserved_zero(p, "parameters");
    return {.time_step = p.time_step,
            .regularization = p.regularization,
            .sub_steps = p.sub_steps,
            .most_sub_steps = p.most_sub_steps,
            .target_area_change = p.target_area_change,
            .tolerance = p.tolerance,
            .max_iterations = p.max_iterations,
            .adaptive_threshold = p.adaptive_threshold,
            .first_regularization = p.first_regularization,
            .stretch_ceiling = p.stretch_ceiling,
            .acceleration = {p.acceleration[0], p.acceleration[1], p.acceleration[2]},
            .damping = p.damping,
            .bending = p.bending,
            .bending_iterations = p.bending_iterations,
            .stepping = static_cast<apsl::Stepping>(p.stepping),
            .enabled = p.enabled != 0};
}

apsl::BufferView view_from(const apsl_buffer_view& view) {
    return {view.buffer, view.offset};
}

std::vector<std::shared_ptr<const apsl::Topology>> topologies_from(const apsl_topology* const* cloths, size_t count) {
    if (count > 0) require(cloths, "cloths");
    std::vector<std::shared_ptr<const apsl::Topology>> topologies;
    for (size_t c = 0; c < count; ++c) {
        require(cloths[c], "a cloth's topology");
        topologies.push_back(cloths[c]->topology);
    }
    return topologies;
}

void create(cl_context context, cl_device_id device, const apsl_topology* const* cloths, size_t cloth_count,
            const apsl_options* options, const void* binary, size_t size, const apsl::BufferView& scratch,
            apsl_limiter** limiter) {
    require(limiter, "limiter");
    *limiter = nullptr;
    if (size > 0) require(binary, "binary");
    *limiter = new apsl_limiter{apsl::StrainLimiter(context, device, topologies_from(cloths, cloth_count),
                                                    options_from(options),
                                                    {static_cast<const std::byte*>(binary), size}, scratch)};
}

/// To the caller, or released where nobody wants it.
void hand_over(cl_event end, cl_event* event) {
    if (event)
        *event = end;
    else
        clReleaseEvent(end);
}

/// What a cloth has at rest, by one of StrainLimiter's three calls, into `target`, an argument of this `name`.
template <class Call>
apsl_result enqueue_rest(const Call& call, apsl_limiter* limiter, cl_command_queue queue,
                         const apsl_buffer_view* rest_positions, const apsl_buffer_view* target, const char* name,
                         cl_uint wait_count, const cl_event* wait_list, cl_event* event) {
    return guarded([&] {
        require(limiter, "limiter");
        require(rest_positions, "rest_positions");
        require(target, name);
        hand_over((limiter->limiter.*call)(queue, view_from(*rest_positions), view_from(*target),
                                           events(wait_count, wait_list)),
                  event);
    });
}

}  // namespace

const char* apsl_last_error(void) {
    return last_error.data();
}

apsl_options apsl_default_options(void) {
    const apsl::Options o;
    return {static_cast<int32_t>(o.matrix),
            static_cast<int32_t>(o.apply),
            static_cast<int32_t>(o.execution),
            o.work_group_size,
            o.position_stride,
            o.velocity_stride,
            o.position_component_stride,
            o.velocity_component_stride,
            o.inverse_mass_stride,
            o.positions_only,
            o.regularization_per_triangle,
            o.warm_start_sub_steps,
            static_cast<int32_t>(o.solver),
            o.bound_interval,
            o.limits_stretch,
            o.stretch_ceiling_per_triangle,
            o.integrates,
            o.keeps_contacts,
            o.bends,
            o.acceleration_per_vertex,
            o.tethers_per_vertex,
            {}};
}

apsl_parameters apsl_default_parameters(void) {
    const apsl::Parameters p;
    return {p.time_step,
            p.regularization,
            p.sub_steps,
            p.target_area_change,
            p.tolerance,
            p.max_iterations,
            p.adaptive_threshold,
            p.first_regularization,
            static_cast<int32_t>(p.stepping),
            p.enabled,
            p.stretch_ceiling,
            p.most_sub_steps,
            {p.acceleration[0], p.acceleration[1], p.acceleration[2]},
            p.damping,
            p.bending,
            p.bending_iterations,
            {}};
}

apsl_result apsl_topology_create(const uint32_t* triangles, size_t triangle_count, size_t vertex_count,
                                 apsl_topology** topology) {
    return guarded([&] {
        require(topology, "topology");
        *topology = nullptr;
        apsl::check_mesh_size(triangle_count, vertex_count);
        require(triangles, "triangles");
        std::vector<apsl::Triangle> list(triangle_count);
        for (size_t a = 0; a < triangle_count; ++a)
            list[a] = {triangles[3 * a], triangles[3 * a + 1], triangles[3 * a + 2]};
        *topology = new apsl_topology{apsl::Topology::build(list, vertex_count)};
    });
}

void apsl_topology_destroy(apsl_topology* topology) {
    delete topology;
}

apsl_result apsl_pinned_piece_count(const apsl_topology* topology, const uint32_t* pinned, size_t pinned_count,
                                    size_t* count) {
    return guarded([&] {
        require(count, "count");
        *count = 0;
        require(topology, "topology");
        *count = apsl::pinned_piece_count(*topology->topology, pins(pinned, pinned_count));
    });
}

apsl_result apsl_tethers_to_pins(const apsl_topology* topology, const float* rest_positions, const uint32_t* pinned,
                                 size_t pinned_count, uint32_t per_vertex, float stretch, uint32_t* anchors,
                                 float* lengths) {
    return guarded([&] {
        require(topology, "topology");
        require(rest_positions, "rest_positions");
        require(anchors, "anchors");
        require(lengths, "lengths");
        const apsl::Tethers tethers =
            apsl::tethers_to_pins(*topology->topology, {rest_positions, 3 * topology->topology->vertex_count()},
                                  pins(pinned, pinned_count), per_vertex, stretch);
        std::copy(tethers.anchors.begin(), tethers.anchors.end(), anchors);
        std::copy(tethers.lengths.begin(), tethers.lengths.end(), lengths);
    });
}

apsl_result apsl_limiter_create(cl_context context, cl_device_id device, const apsl_topology* const* cloths,
                                size_t cloth_count, const apsl_options* options, apsl_limiter** limiter) {
    return apsl_limiter_create_from_binary(context, device, cloths, cloth_count, options, nullptr, 0, limiter);
}

apsl_result apsl_limiter_create_from_binary(cl_context context, cl_device_id device, const apsl_topology* const* cloths,
                                            size_t cloth_count, const apsl_options* options, const void* binary,
                                            size_t size, apsl_limiter** limiter) {
    return guarded([&] { create(context, device, cloths, cloth_count, options, binary, size, {}, limiter); });
}

apsl_result apsl_limiter_create_in_scratch(cl_context context, cl_device_id device, const apsl_topology* const* cloths,
                                           size_t cloth_count, const apsl_options* options, const void* binary,
                                           size_t size, const apsl_buffer_view* scratch, apsl_limiter** limiter) {
    return guarded([&] {
        if (limiter) *limiter = nullptr;
        require(scratch, "scratch");
        require(scratch->buffer, "scratch's buffer");
        create(context, device, cloths, cloth_count, options, binary, size, view_from(*scratch), limiter);
    });
}

apsl_result apsl_limiter_required_scratch_bytes(cl_device_id device, const apsl_topology* const* cloths,
                                                size_t cloth_count, const apsl_options* options, size_t* bytes) {
    return guarded([&] {
        require(bytes, "bytes");
        *bytes = 0;
        *bytes = apsl::StrainLimiter::required_scratch_bytes(device, topologies_from(cloths, cloth_count),
                                                             options_from(options));
    });
}

apsl_result apsl_limiter_rebuild(apsl_limiter* limiter, const apsl_topology* const* cloths, size_t cloth_count,
                                 const apsl_buffer_view* scratch) {
    return guarded([&] {
        require(limiter, "limiter");
        limiter->limiter.rebuild(topologies_from(cloths, cloth_count),
                                 scratch ? view_from(*scratch) : apsl::BufferView{});
    });
}

void apsl_limiter_destroy(apsl_limiter* limiter) {
    delete limiter;
}

size_t apsl_limiter_scratch_bytes(const apsl_limiter* limiter) {
    return limiter ? limiter->limiter.scratch_bytes() : 0;
}

apsl_result apsl_limiter_program_binary(const apsl_limiter* limiter, void* binary, size_t capacity, size_t* size) {
    return guarded([&] {
        require(limiter, "limiter");
        require(size, "size");
        const std::vector<std::byte> bytes = limiter->limiter.program_binary();
        *size = bytes.size();
        if (!binary || bytes.empty()) return;
        if (capacity < bytes.size())
            throw apsl::Error(apsl::ErrorCode::invalid_argument, "capacity is " + std::to_string(capacity) +
                                                                     ", expected at least the binary's " +
                                                                     std::to_string(bytes.size()) + " bytes");
        std::memcpy(binary, bytes.data(), bytes.size());
    });
}

apsl_program_binary_use apsl_limiter_program_binary_use(const apsl_limiter* limiter) {
    return limiter ? static_cast<apsl_program_binary_use>(limiter->limiter.program_binary_use())
                   : APSL_PROGRAM_BINARY_NONE_GIVEN;
}

apsl_result apsl_limiter_enqueue(apsl_limiter* limiter, cl_command_queue queue, const apsl_buffers* buffers,
                                 const apsl_parameters* parameters, size_t parameter_count, cl_uint wait_count,
                                 const cl_event* wait_list, cl_event* event) {
    return guarded([&] {
        require(limiter, "limiter");
        require(buffers, "buffers");
        if (parameter_count > 0) require(parameters, "parameters");
        // Before an entry is read: there may be fewer than the count says.
        apsl::host::check_parameter_count(parameter_count, limiter->limiter.cloth_count());
        std::vector<apsl::Parameters> list;
        for (size_t c = 0; c < parameter_count; ++c) list.push_back(parameters_from(parameters[c]));
        const apsl::Buffers views{.positions = view_from(buffers->positions),
                                  .velocities = view_from(buffers->velocities),
                                  .inverse_masses = view_from(buffers->inverse_masses),
                                  .rest_areas = view_from(buffers->rest_areas),
                                  .regularization = view_from(buffers->regularization),
                                  .rest_shapes = view_from(buffers->rest_shapes),
                                  .stretch_ceilings = view_from(buffers->stretch_ceilings),
                                  .contacts = view_from(buffers->contacts),
                                  .rest_hinges = view_from(buffers->rest_hinges),
                                  .accelerations = view_from(buffers->accelerations),
                                  .tether_anchors = view_from(buffers->tether_anchors),
                                  .tether_lengths = view_from(buffers->tether_lengths)};
        const cl_event end = limiter->limiter.enqueue(queue, views, list, events(wait_count, wait_list));
        hand_over(end, event);
    });
}

apsl_result apsl_limiter_enqueue_rest_areas(apsl_limiter* limiter, cl_command_queue queue,
                                            const apsl_buffer_view* rest_positions, const apsl_buffer_view* rest_areas,
                                            cl_uint wait_count, const cl_event* wait_list, cl_event* event) {
    return enqueue_rest(&apsl::StrainLimiter::enqueue_rest_areas, limiter, queue, rest_positions, rest_areas,
                        "rest_areas", wait_count, wait_list, event);
}

apsl_result apsl_limiter_enqueue_rest_shapes(apsl_limiter* limiter, cl_command_queue queue,
                                             const apsl_buffer_view* rest_positions,
                                             const apsl_buffer_view* rest_shapes, cl_uint wait_count,
                                             const cl_event* wait_list, cl_event* event) {
    return enqueue_rest(&apsl::StrainLimiter::enqueue_rest_shapes, limiter, queue, rest_positions, rest_shapes,
                        "rest_shapes", wait_count, wait_list, event);
}

apsl_result apsl_limiter_enqueue_rest_hinges(apsl_limiter* limiter, cl_command_queue queue,
                                             const apsl_buffer_view* rest_positions,
                                             const apsl_buffer_view* rest_hinges, cl_uint wait_count,
                                             const cl_event* wait_list, cl_event* event) {
    return enqueue_rest(&apsl::StrainLimiter::enqueue_rest_hinges, limiter, queue, rest_positions, rest_hinges,
                        "rest_hinges", wait_count, wait_list, event);
}

apsl_result apsl_limiter_read_stats(const apsl_limiter* limiter, cl_command_queue queue, apsl_stats* stats,
                                    size_t stats_count, cl_uint wait_count, const cl_event* wait_list,
                                    cl_event* event) {
    return guarded([&] {
        require(limiter, "limiter");
        require(event, "event");
        if (stats_count > 0) require(stats, "stats");
        // The device writes the bytes; both structs are its layout.
        const std::span<apsl::Stats> list(reinterpret_cast<apsl::Stats*>(stats), stats_count);
        *event = limiter->limiter.read_stats(queue, list, events(wait_count, wait_list));
    });
}
