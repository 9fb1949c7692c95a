// SPDX-License-Identifier: MIT
//
// The README's embedding snippet, whole, between the markers: tests/embed/readme_snippet.cmake holds the two together.
#include "embed/snippet.hpp"

// [snippet]
#include <apsl/strain_limiter.hpp>

// Once: what the mesh is, and a limiter in your context.
apsl::StrainLimiter make_limiter(cl_context context, cl_device_id device, const std::vector<apsl::Triangle>& triangles,
                                 std::size_t vertex_count) {
    return {context, device, apsl::Topology::build(triangles, vertex_count)};
}

// Every step, after your integrator and before your collisions: velocities in, velocities out.
apsl::Stats limit_strain(apsl::StrainLimiter& limiter, cl_command_queue queue, cl_mem positions, cl_mem velocities,
                         cl_mem inverse_masses, cl_mem rest_areas) {
    const apsl::Buffers buffers{.positions = {positions},            // m, the start of the step
                                .velocities = {velocities},          // m/s, in and out
                                .inverse_masses = {inverse_masses},  // 1/kg, 0 pins a vertex
                                .rest_areas = {rest_areas}};         // m²
    const apsl::Parameters parameters{.time_step = 1.0f / 60.0f};
    const cl_event limited = limiter.enqueue(queue, buffers, parameters);  // returns at once

    apsl::Stats stats{};  // leave this out where nobody looks: it is the only thing that waits
    const cl_event read = limiter.read_stats(queue, {&stats, 1}, {&limited, 1});
    clWaitForEvents(1, &read);
    clReleaseEvent(read);
    clReleaseEvent(limited);
    return stats;  // .max_area_change is what is left, .status how it went
}
// [/snippet]
