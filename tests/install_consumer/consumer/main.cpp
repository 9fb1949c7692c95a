// SPDX-License-Identifier: MIT
// The least an embedding program does: builds a limiter for two triangles on the first device there is.
#include <apsl/strain_limiter.hpp>
#include <apsl/version.hpp>

#include <array>
#include <cstdio>

int main() {
    cl_platform_id platform = nullptr;
    cl_device_id device = nullptr;
    if (clGetPlatformIDs(1, &platform, nullptr) != CL_SUCCESS ||
        clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, nullptr) != CL_SUCCESS) {
        std::fputs("no OpenCL device found, expected at least one\n", stderr);
        return 1;
    }
    cl_int status = CL_SUCCESS;
    const cl_context context = clCreateContext(nullptr, 1, &device, nullptr, nullptr, &status);
    if (status != CL_SUCCESS) return 1;

    constexpr std::array<apsl::Triangle, 2> triangles{{{0, 1, 2}, {2, 1, 3}}};
    const auto topology = apsl::Topology::build(triangles, 4);
    const apsl::StrainLimiter limiter(context, device, topology);
    std::printf("apsl %d.%d.%d: %zu bytes for %zu triangles\n", APSL_VERSION_MAJOR, APSL_VERSION_MINOR,
                APSL_VERSION_PATCH, limiter.scratch_bytes(), topology->triangle_count());
    clReleaseContext(context);
    return limiter.scratch_bytes() > 0 ? 0 : 1;
}
