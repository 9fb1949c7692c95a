// SPDX-License-Identifier: MIT
#include "device_filter.hpp"

#include <algorithm>
#include <chrono>

namespace apsl::bench {
namespace {

std::vector<float> repeated(const std::vector<float>& numbers, std::size_t copies) {
    std::vector<float> all;
    all.reserve(numbers.size() * copies);
    for (std::size_t n = 0; n < copies; ++n) all.insert(all.end(), numbers.begin(), numbers.end());
    return all;
}

StrainLimiter make_limiter(const Device& device, const Cloth& cloth, Apply apply, std::size_t copies) {
    Options options;
    options.apply = apply;
    const std::vector<std::shared_ptr<const Topology>> topologies(copies, cloth.topology);
    return {device.context.get(), device.id, topologies, options};
}

void wait_and_release(cl_event event) {
    check(clWaitForEvents(1, &event), "waiting for the filter");
    check(clReleaseEvent(event), "releasing an event");
}

}  // namespace

DeviceFilter::DeviceFilter(const Device& device, const Cloth& cloth, Apply apply, std::size_t copies)
    : device_(device),
      velocity_bytes_(copies * cloth.positions.size() * sizeof(float)),
      positions_(device.upload(repeated(cloth.positions, copies))),
      velocities_(device.buffer(velocity_bytes_)),
      inverse_masses_(device.upload(repeated(cloth.inverse_masses, copies))),
      rest_areas_(device.upload(repeated(cloth.rest_areas, copies))),
      limiter_(make_limiter(device, cloth, apply, copies)) {
}

double DeviceFilter::run(cl_command_queue queue, const Parameters& parameters) {
    const cl_float zero = 0.0f;
    check(clEnqueueFillBuffer(queue, velocities_.get(), &zero, sizeof zero, 0, velocity_bytes_, 0, nullptr, nullptr),
          "clearing velocities");
    check(clFinish(queue), "clearing velocities");
    const apsl::Buffers buffers{
        {positions_.get()}, {velocities_.get()}, {inverse_masses_.get()}, {rest_areas_.get()}, {}};
    const auto start = std::chrono::steady_clock::now();
    const cl_event done = limiter_.enqueue(queue, buffers, parameters);
    check(clFlush(queue), "sending off the filter");
    wait_and_release(done);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double DeviceFilter::wall_seconds(const Parameters& parameters) {
    return run(device_.queue.get(), parameters);
}

std::vector<KernelTime> DeviceFilter::kernel_times(const Parameters& parameters) {
    limiter_.set_profiling(true);
    run(device_.profiling_queue.get(), parameters);
    limiter_.set_profiling(false);
    return limiter_.profile();
}

std::vector<float> DeviceFilter::velocities() const {
    std::vector<float> result(velocity_bytes_ / sizeof(float));
    check(clEnqueueReadBuffer(device_.queue.get(), velocities_.get(), CL_TRUE, 0, velocity_bytes_, result.data(), 0,
                              nullptr, nullptr),
          "reading velocities");
    return result;
}

float DeviceFilter::max_area_change() const {
    std::vector<Stats> stats(limiter_.cloth_count());
    wait_and_release(limiter_.read_stats(device_.queue.get(), stats));
    float greatest = 0.0f;
    for (const Stats& cloth : stats) {
        if (cloth.status == Status::diverged) throw std::runtime_error("the filter diverged");
        greatest = std::max(greatest, cloth.max_area_change);
    }
    return greatest;
}

}  // namespace apsl::bench
