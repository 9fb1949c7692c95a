// SPDX-License-Identifier: MIT
//
// A first program: one step of a curtain that is being pulled 10 % longer. docs/embedding.md quotes it whole.
// [snippet]
#include <apsl/strain_limiter.hpp>
#include <cstdio>

int main() {
    cl_platform_id platform;
    cl_device_id device;
    if (clGetPlatformIDs(1, &platform, nullptr) || clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, nullptr))
        return 1;
    const cl_context context = clCreateContext(nullptr, 1, &device, nullptr, nullptr, nullptr);
    const cl_command_queue queue = clCreateCommandQueue(context, device, 0, nullptr);

    constexpr std::uint32_t side = 33;  // vertices; 1 m by 1 m, 200 g, held along its upper edge
    std::vector<apsl::Triangle> triangles;
    std::vector<float> x, v, inverse_masses;
    for (std::uint32_t n = 0; n < side * side; ++n) {
        x.insert(x.end(), {float(n % side) / 32.0f, float(n / side) / -32.0f, 0.0f});  // m
        v.insert(v.end(), {0.0f, 6.0f * x[3 * n + 1], 0.0f});                          // m/s: 10 % longer in 1/60 s
        inverse_masses.push_back(n < side ? 0.0f : float(side * side) / 0.2f);         // 1/kg; 0 pins the upper edge
        if (n % side == side - 1 || n / side == side - 1) continue;
        triangles.insert(triangles.end(), {{n, n + side, n + 1}, {n + 1, n + side, n + side + 1}});
    }
    const std::vector<float> rest_areas(triangles.size(), 0.5f / (32 * 32));  // m²
    const auto upload = [&](std::vector<float> f) {
        return clCreateBuffer(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, 4 * f.size(), f.data(), nullptr);
    };
    const apsl::Buffers buffers{{upload(x)}, {upload(v)}, {upload(inverse_masses)}, {upload(rest_areas)}};
    apsl::StrainLimiter limiter(context, device, apsl::Topology::build(triangles, side * side));
    const cl_event limited = limiter.enqueue(queue, buffers, apsl::Parameters{.time_step = 1.0f / 60.0f});
    apsl::Stats stats{};
    const cl_event read = limiter.read_stats(queue, {&stats, 1}, {&limited, 1});
    clWaitForEvents(1, &read);
    std::printf("greatest area change %.1f %% without, %.1f %% with the limiter\n",
                100.0 * stats.initial_max_area_change, 100.0 * stats.max_area_change);
}
// [/snippet]
