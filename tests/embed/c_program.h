/* SPDX-License-Identifier: MIT */
#ifndef APSL_TESTS_EMBED_C_PROGRAM_H
#define APSL_TESTS_EMBED_C_PROGRAM_H

#include <apsl/apsl.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A C program's use of the library: builds topology and limiter, filters once with the default options but for
 * execution and the default parameters, reads the statistics. Returns the first failure, with everything released
 * either way. */
apsl_result filter_in_c(cl_context context, cl_device_id device, cl_command_queue queue, const uint32_t* triangles,
                        size_t triangle_count, size_t vertex_count, apsl_execution execution,
                        const apsl_buffers* buffers, apsl_stats* stats, size_t* scratch_bytes);

#ifdef __cplusplus
}
#endif

#endif
