// SPDX-License-Identifier: MIT
//
// Compiled with -ffast-math and -fno-exceptions: numbers that are not finite are refused all the same, and a call
// works.
#include <apsl/apsl.h>
#include <apsl/strain_limiter.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace {

void require(bool holds, const char* what) {
    if (holds) return;
    std::printf("%s; the last error: %s\n", what, apsl_last_error());
    std::exit(1);
}

const float infinity = std::bit_cast<float>(std::uint32_t{0x7f800000});
const float not_a_number = std::bit_cast<float>(std::uint32_t{0x7fc00000});

}  // namespace

int main() {
    // A copy of this function, true for all numbers, that the linker could take for the library's.
    std::printf("std::isfinite(infinity) is %d here\n", std::isfinite(infinity));

    cl_platform_id platform = nullptr;
    cl_device_id device = nullptr;
    require(clGetPlatformIDs(1, &platform, nullptr) == CL_SUCCESS, "no platform");
    require(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, nullptr) == CL_SUCCESS, "no device");
    const cl_context context = clCreateContext(nullptr, 1, &device, nullptr, nullptr, nullptr);
    const cl_command_queue queue = clCreateCommandQueueWithProperties(context, device, nullptr, nullptr);

    const std::uint32_t triangle[] = {0, 1, 2};
    apsl_topology* topology = nullptr;
    apsl_limiter* limiter = nullptr;
    require(apsl_topology_create(triangle, 1, 3, &topology) == APSL_SUCCESS, "no topology");
    require(apsl_limiter_create(context, device, &topology, 1, nullptr, &limiter) == APSL_SUCCESS, "no limiter");

    float numbers[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const auto upload = [&](std::size_t floats) {
        return apsl_buffer_view{clCreateBuffer(context, CL_MEM_COPY_HOST_PTR, floats * sizeof(float), numbers, nullptr),
                                0};
    };
    apsl_buffers buffers{};
    buffers.positions = upload(9);
    buffers.velocities = upload(9);
    buffers.inverse_masses = upload(3);
    buffers.rest_areas = upload(1);
    const auto enqueue = [&](const apsl_parameters& parameters) {
        return apsl_limiter_enqueue(limiter, queue, &buffers, &parameters, 1, 0, nullptr, nullptr);
    };
    const std::pair<const char*, float apsl_parameters::*> fields[] = {
        {"time_step", &apsl_parameters::time_step},
        {"regularization", &apsl_parameters::regularization},
        {"target_area_change", &apsl_parameters::target_area_change},
        {"tolerance", &apsl_parameters::tolerance},
        {"first_regularization", &apsl_parameters::first_regularization}};
    for (const auto& [name, field] : fields)
        for (const float number : {infinity, not_a_number}) {
            apsl_parameters parameters = apsl_default_parameters();
            parameters.*field = number;
            require(enqueue(parameters) == APSL_ERROR_INVALID_ARGUMENT, name);
            require(std::string_view(apsl_last_error()).find(name) == 0, name);
        }
    require(enqueue(apsl_default_parameters()) == APSL_SUCCESS, "the defaults are refused");
    require(clFinish(queue) == CL_SUCCESS, "clFinish");
    apsl_limiter_destroy(limiter);
    apsl_topology_destroy(topology);
    std::puts("what is not finite is refused");
}
