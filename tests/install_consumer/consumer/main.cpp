// SPDX-License-Identifier: MIT
// An embedding program in C++: a square of two triangles about to be stretched by a tenth each way, filtered on the
// first device there is. Exit 0 where the areas at x + Δt v are then near their rest areas again.
#include <apsl/strain_limiter.hpp>
#include <apsl/version.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace {

constexpr std::array<apsl::Triangle, 2> triangles{{{0, 1, 2}, {2, 1, 3}}};
constexpr std::array<float, 12> positions{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
constexpr std::array<float, 4> inverse_masses{1, 1, 1, 1};
constexpr std::array<float, 2> rest_areas{0.5f, 0.5f};

/// The greatest |A − A⁰| / A⁰ at x + Δt v; the cloth lies in the plane z = 0.
double max_area_change(const std::array<float, 12>& velocities, float time_step) {
    double greatest = 0.0;
    for (std::size_t a = 0; a < triangles.size(); ++a) {
        const auto at = [&](int corner, std::size_t axis) {
            const std::size_t i = 3 * triangles[a][static_cast<std::size_t>(corner)] + axis;
            return static_cast<double>(positions[i] + time_step * velocities[i]);
        };
        const double area = 0.5 * std::abs((at(1, 0) - at(0, 0)) * (at(2, 1) - at(0, 1)) -
                                           (at(1, 1) - at(0, 1)) * (at(2, 0) - at(0, 0)));
        greatest = std::max(greatest, std::abs(area - rest_areas[a]) / rest_areas[a]);
    }
    return greatest;
}

}  // namespace

int main() {
    cl_platform_id platform = nullptr;
    cl_device_id device = nullptr;
    if (clGetPlatformIDs(1, &platform, nullptr) != CL_SUCCESS ||
        clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, nullptr) != CL_SUCCESS) {
        std::fputs("no OpenCL device found, expected at least one\n", stderr);
        return 1;
    }
    const cl_context context = clCreateContext(nullptr, 1, &device, nullptr, nullptr, nullptr);
    const cl_command_queue queue = clCreateCommandQueueWithProperties(context, device, nullptr, nullptr);
    const auto upload = [&](const auto& values) {
        const cl_mem memory = clCreateBuffer(context, CL_MEM_READ_WRITE, sizeof values, nullptr, nullptr);
        clEnqueueWriteBuffer(queue, memory, CL_TRUE, 0, sizeof values, values.data(), 0, nullptr, nullptr);
        return memory;
    };

    const apsl::Parameters parameters;
    std::array<float, 12> velocities{};
    for (std::size_t i = 0; i < velocities.size(); ++i) velocities[i] = 0.1f * positions[i] / parameters.time_step;
    const double before = max_area_change(velocities, parameters.time_step);

    const apsl::Buffers buffers{.positions = {upload(positions)},
                                .velocities = {upload(velocities)},
                                .inverse_masses = {upload(inverse_masses)},
                                .rest_areas = {upload(rest_areas)}};
    {
        apsl::StrainLimiter limiter(context, device, apsl::Topology::build(triangles, 4));
        const cl_event limited = limiter.enqueue(queue, buffers, parameters);
        clEnqueueReadBuffer(queue, buffers.velocities.buffer, CL_TRUE, 0, sizeof velocities, velocities.data(), 1,
                            &limited, nullptr);
        clReleaseEvent(limited);
    }
    const double after = max_area_change(velocities, parameters.time_step);
    for (const apsl::BufferView& view :
         {buffers.positions, buffers.velocities, buffers.inverse_masses, buffers.rest_areas})
        clReleaseMemObject(view.buffer);
    clReleaseCommandQueue(queue);
    clReleaseContext(context);

    std::printf("apsl %d.%d.%d from C++: greatest area change %.3f %% unfiltered, %.3f %% filtered\n",
                APSL_VERSION_MAJOR, APSL_VERSION_MINOR, APSL_VERSION_PATCH, 100.0 * before, 100.0 * after);
    if (before > 0.2 && after < 0.02) return 0;
    std::fputs("expected more than 20 % before and less than 2 % after\n", stderr);
    return 1;
}
