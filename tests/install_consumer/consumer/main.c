/* SPDX-License-Identifier: MIT */
/* An embedding program in C: a cloth about to be stretched by a tenth each way, filtered on the first device there is.
 * Exit 0 where the triangles' areas at x + dt v are then near their rest areas again. */
#include <apsl/apsl.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 5, VERTICES = SIDE * SIDE, TRIANGLES = 2 * (SIDE - 1) * (SIDE - 1) };

static uint32_t triangles[3 * TRIANGLES];
static float positions[3 * VERTICES], velocities[3 * VERTICES], inverse_masses[VERTICES], rest_areas[TRIANGLES];

static void make_cloth(float time_step) {
    const float spacing = 0.1f;
    uint32_t* t = triangles;
    for (uint32_t r = 0; r + 1 < SIDE; ++r)
        for (uint32_t c = 0; c + 1 < SIDE; ++c) {
            const uint32_t v = r * SIDE + c;
            const uint32_t square[6] = {v, v + 1, v + SIDE, v + SIDE, v + 1, v + SIDE + 1};
            memcpy(t, square, sizeof square);
            t += 6;
        }
    for (int v = 0; v < VERTICES; ++v) {
        positions[3 * v] = spacing * (float)(v % SIDE);
        positions[3 * v + 1] = spacing * (float)(v / SIDE);
        for (int k = 0; k < 2; ++k) velocities[3 * v + k] = 0.1f * positions[3 * v + k] / time_step;
        inverse_masses[v] = 100.0f;
    }
    for (int a = 0; a < TRIANGLES; ++a) rest_areas[a] = 0.5f * spacing * spacing;
}

/* The greatest |A - A0| / A0 at x + dt v; the cloth lies in the plane z = 0. */
static double max_area_change(float time_step) {
    double greatest = 0.0;
    for (int a = 0; a < TRIANGLES; ++a) {
        double p[3][2];
        for (int k = 0; k < 3; ++k)
            for (int i = 0; i < 2; ++i) {
                const uint32_t at = 3 * triangles[3 * a + k] + (uint32_t)i;
                p[k][i] = positions[at] + time_step * velocities[at];
            }
        const double area =
            0.5 * fabs((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]));
        greatest = fmax(greatest, fabs(area - rest_areas[a]) / rest_areas[a]);
    }
    return greatest;
}

static void require(int done, const char* what) {
    if (done) return;
    fprintf(stderr, "%s: %s\n", what, apsl_last_error());
    exit(1);
}

int main(void) {
    cl_platform_id platform = NULL;
    cl_device_id device = NULL;
    cl_int status = CL_SUCCESS;
    require(clGetPlatformIDs(1, &platform, NULL) == CL_SUCCESS &&
                clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, NULL) == CL_SUCCESS,
            "no OpenCL device found, expected at least one");
    cl_context context = clCreateContext(NULL, 1, &device, NULL, NULL, &status);
    require(status == CL_SUCCESS, "clCreateContext");
    cl_command_queue queue = clCreateCommandQueueWithProperties(context, device, NULL, &status);
    require(status == CL_SUCCESS, "clCreateCommandQueueWithProperties");

    apsl_parameters parameters = apsl_default_parameters();
    make_cloth(parameters.time_step);
    const double before = max_area_change(parameters.time_step);
    void* const arrays[4] = {positions, velocities, inverse_masses, rest_areas};
    const size_t sizes[4] = {sizeof positions, sizeof velocities, sizeof inverse_masses, sizeof rest_areas};
    cl_mem memory[4];
    for (int i = 0; i < 4; ++i) {
        memory[i] = clCreateBuffer(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, sizes[i], arrays[i], &status);
        require(status == CL_SUCCESS, "clCreateBuffer");
    }

    apsl_topology* topology = NULL;
    apsl_limiter* limiter = NULL;
    require(apsl_topology_create(triangles, TRIANGLES, VERTICES, &topology) == APSL_SUCCESS, "apsl_topology_create");
    const apsl_topology* const cloths[1] = {topology};
    require(apsl_limiter_create(context, device, cloths, 1, NULL, &limiter) == APSL_SUCCESS, "apsl_limiter_create");
    apsl_topology_destroy(topology);
    apsl_buffers buffers;
    memset(&buffers, 0, sizeof buffers);
    buffers.positions.buffer = memory[0];
    buffers.velocities.buffer = memory[1];
    buffers.inverse_masses.buffer = memory[2];
    buffers.rest_areas.buffer = memory[3];
    require(apsl_limiter_enqueue(limiter, queue, &buffers, &parameters, 1, 0, NULL, NULL) == APSL_SUCCESS,
            "apsl_limiter_enqueue");
    require(
        clEnqueueReadBuffer(queue, memory[1], CL_TRUE, 0, sizeof velocities, velocities, 0, NULL, NULL) == CL_SUCCESS,
        "clEnqueueReadBuffer");
    const double after = max_area_change(parameters.time_step);

    apsl_limiter_destroy(limiter);
    for (int i = 0; i < 4; ++i) clReleaseMemObject(memory[i]);
    clReleaseCommandQueue(queue);
    clReleaseContext(context);

    printf("apsl %s from C: greatest area change %.3f %% unfiltered, %.3f %% filtered\n", apsl_version(),
           100.0 * before, 100.0 * after);
    require(apsl_version_number() == APSL_VERSION_NUMBER, "headers and library are of different versions");
    require(before > 0.2 && after < 0.02, "expected more than 20 % before and less than 2 % after");
    return 0;
}
