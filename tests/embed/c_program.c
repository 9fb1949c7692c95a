/* SPDX-License-Identifier: MIT */
#include "embed/c_program.h"

apsl_result filter_in_c(cl_context context, cl_device_id device, cl_command_queue queue, const uint32_t* triangles,
                        size_t triangle_count, size_t vertex_count, apsl_execution execution,
                        const apsl_buffers* buffers, apsl_stats* stats, size_t* scratch_bytes) {
    apsl_topology* topology = NULL;
    apsl_limiter* limiter = NULL;
    cl_event limited = NULL;
    cl_event read = NULL;
    apsl_options options = apsl_default_options();
    const apsl_parameters parameters = apsl_default_parameters();
    options.execution = (int32_t)execution;

    apsl_result result = apsl_topology_create(triangles, triangle_count, vertex_count, &topology);
    if (result == APSL_SUCCESS) {
        const apsl_topology* cloth = topology;
        result = apsl_limiter_create(context, device, &cloth, 1, &options, &limiter);
    }
    apsl_topology_destroy(topology); /* the limiter lives on without it */
    *scratch_bytes = apsl_limiter_scratch_bytes(limiter);
    if (result == APSL_SUCCESS)
        result = apsl_limiter_enqueue(limiter, queue, buffers, &parameters, 1, 0, NULL, &limited);
    if (result == APSL_SUCCESS) result = apsl_limiter_read_stats(limiter, queue, stats, 1, 1, &limited, &read);
    if (read) {
        clWaitForEvents(1, &read);
        clReleaseEvent(read);
    }
    if (limited) clReleaseEvent(limited);
    apsl_limiter_destroy(limiter);
    return result;
}
