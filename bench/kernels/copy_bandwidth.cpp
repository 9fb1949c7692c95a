// SPDX-License-Identifier: MIT
#include "copy_bandwidth.hpp"

#include <algorithm>
#include <array>

namespace apsl::bench {
namespace {

// Each group a contiguous share, as the filter's kernels have it.
constexpr const char* source = R"(
__kernel void triad(__global float4* a, __global const float4* b, __global const float4* c, float s, uint count) {
    const uint share = (count + get_num_groups(0) - 1) / get_num_groups(0);
    const uint first = get_group_id(0) * share;
    const uint end = min(first + share, count);
    for (uint n = first + get_local_id(0); n < end; n += get_local_size(0)) a[n] = b[n] + s * c[n];
}
)";

double seconds_of(cl_event event) {
    check(clWaitForEvents(1, &event), "waiting for the triad");
    std::array<cl_ulong, 2> times{};
    check(clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof(cl_ulong), &times[0], nullptr),
          "reading an event's time");
    check(clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof(cl_ulong), &times[1], nullptr),
          "reading an event's time");
    check(clReleaseEvent(event), "releasing an event");
    return 1e-9 * static_cast<double>(times[1] - times[0]);
}

}  // namespace

double copy_bandwidth(const Device& device, std::size_t array_bytes) {
    const cl_context context = device.context.get();
    cl_int status = CL_SUCCESS;
    const char* text = source;
    const host::ProgramHandle program(clCreateProgramWithSource(context, 1, &text, nullptr, &status));
    check(status, "creating the triad");
    check(clBuildProgram(program.get(), 1, &device.id, "-cl-std=CL1.2", nullptr, nullptr), "building the triad");
    const host::KernelHandle kernel(clCreateKernel(program.get(), "triad", &status));
    check(status, "creating the triad");

    const auto count = static_cast<cl_uint>(array_bytes / sizeof(cl_float4));
    const std::vector<float> numbers(std::size_t{count} * 4, 1.0f);
    const std::array<host::BufferHandle, 3> buffers{device.upload(numbers), device.upload(numbers),
                                                    device.upload(numbers)};
    for (cl_uint n = 0; n < 3; ++n) {
        const cl_mem buffer = buffers[n].get();
        check(clSetKernelArg(kernel.get(), n, sizeof buffer, &buffer), "setting an argument");
    }
    const cl_float factor = 0.5f;
    check(clSetKernelArg(kernel.get(), 3, sizeof factor, &factor), "setting an argument");
    check(clSetKernelArg(kernel.get(), 4, sizeof count, &count), "setting an argument");

    double best = 0.0;
    const auto units = static_cast<std::size_t>(device.place.threads);
    for (const std::size_t group_size : device.is_cpu ? std::vector<std::size_t>{1, 64} : std::vector<std::size_t>{256})
        for (const std::size_t groups : {units, 8 * units, 64 * units})
            for (int launch = 0; launch < 8; ++launch) {
                const std::size_t items = groups * group_size;
                cl_event event = nullptr;
                check(clEnqueueNDRangeKernel(device.profiling_queue.get(), kernel.get(), 1, nullptr, &items,
                                             &group_size, 0, nullptr, &event),
                      "launching the triad");
                const double seconds = seconds_of(event);
                const double bytes = 3.0 * sizeof(cl_float4) * count;
                if (seconds > 0.0) best = std::max(best, bytes / seconds);
            }
    return best;
}

}  // namespace apsl::bench
