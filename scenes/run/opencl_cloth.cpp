// SPDX-License-Identifier: MIT
#include "run/opencl_cloth.hpp"

#include "run/check_opencl.hpp"
#include "run/rest_shapes.hpp"
#include "run/scene_tethers.hpp"

#include <apsl/reference.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <limits>

namespace apsl::scenes {
namespace {

host::ContextHandle make_context(cl_device_id device) {
    cl_int code = CL_SUCCESS;
    host::ContextHandle context(clCreateContext(nullptr, 1, &device, nullptr, nullptr, &code));
    check_opencl(code, "clCreateContext");
    return context;
}

host::QueueHandle make_queue(cl_context context, cl_device_id device, bool profile) {
    cl_int code = CL_SUCCESS;
    const cl_command_queue_properties properties = profile ? CL_QUEUE_PROFILING_ENABLE : 0;
    host::QueueHandle queue(clCreateCommandQueue(context, device, properties, &code));
    check_opencl(code, "clCreateCommandQueue");
    return queue;
}

}  // namespace

std::vector<float> to_float(const std::vector<double>& values) {
    return {values.begin(), values.end()};
}

std::array<double, 3> origin_for(const std::vector<double>& positions) {
    constexpr double far = 4.0;  // times the extent: two bits of 24
    Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Array3d high = -low;
    for (std::size_t i = 0; i < positions.size(); i += 3) {
        const Eigen::Map<const Eigen::Array3d> place(positions.data() + i);
        low = low.min(place);
        high = high.max(place);
    }
    const Eigen::Array3d center = low + 0.5 * (high - low);
    if (!(center.abs().maxCoeff() > far * (high - low).maxCoeff())) return {};
    return {center[0], center[1], center[2]};
}

std::vector<float> to_float_around(const std::array<double, 3>& origin, const std::vector<double>& positions) {
    std::vector<float> floats(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) floats[i] = static_cast<float>(positions[i] - origin[i % 3]);
    return floats;
}

OpenClCloth::OpenClCloth(const OpenClDevice& device, const ClothState& cloth, const StrainLimiting& settings,
                         bool profile)
    : device_name_(device.name),
      device_(device.id),
      parameters_(settings.parameters),
      profile_(profile),
      context_(make_context(device.id)),
      queue_(make_queue(context_.get(), device.id, profile)),
      limiter_(context_.get(), device.id, cloth.topology, settings.options) {
    positions_ = make_buffer(to_float_around(origin_for(cloth.positions), cloth.positions), "positions");
    velocities_ = make_buffer(to_float(cloth.velocities), "velocities");
    inverse_masses_ = make_buffer(to_float(cloth.inverse_masses), "inverse masses");
    rest_areas_ = make_buffer(to_float(cloth.rest_areas), "rest areas");
    if (!settings.regularization.empty()) regularization_ = make_buffer(settings.regularization, "regularization");
    if (settings.options.limits_stretch) rest_shapes_ = make_buffer(to_float(rest_shapes(cloth)), "rest shapes");
    if (settings.options.bends && cloth.topology->hinge_count() > 0)
        rest_hinges_ =
            make_buffer(to_float(reference::rest_hinges<double>(*cloth.topology, cloth.rest_positions)), "rest hinges");
    if (settings.options.tethers_per_vertex > 0) {
        const Tethers tethers = scene_tethers(cloth, settings);
        tether_anchors_ = make_buffer(std::as_bytes(std::span(tethers.anchors)), "anchors of tethers");
        tether_lengths_ = make_buffer(tethers.lengths, "lengths of tethers");
    }
    if (settings.options.stretch_ceiling_per_triangle)
        stretch_ceilings_ = make_buffer(settings.stretch_ceilings, "stretch ceilings");
    limiter_.set_profiling(profile);
}

host::BufferHandle OpenClCloth::make_buffer(std::span<const std::byte> bytes, const std::string& name) {
    cl_int code = CL_SUCCESS;
    // CL_MEM_COPY_HOST_PTR only reads what it is given.
    host::BufferHandle buffer(clCreateBuffer(context_.get(), CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, bytes.size(),
                                             const_cast<std::byte*>(bytes.data()), &code));
    check_opencl(code, "allocating " + std::to_string(bytes.size()) + " bytes of " + name);
    buffer_bytes_ += bytes.size();
    return buffer;
}

host::BufferHandle OpenClCloth::make_buffer(const std::vector<float>& values, const std::string& name) {
    return make_buffer(std::as_bytes(std::span(values)), name);
}

void OpenClCloth::queue_call(cl_mem contacts) {
    const Buffers buffers{.positions = {positions_.get()},
                          .velocities = {velocities_.get()},
                          .inverse_masses = {inverse_masses_.get()},
                          .rest_areas = {rest_areas_.get()},
                          .regularization = {regularization_.get()},
                          .rest_shapes = {rest_shapes_.get()},
                          .stretch_ceilings = {stretch_ceilings_.get()},
                          .contacts = {contacts},
                          .rest_hinges = {rest_hinges_.get()},
                          .tether_anchors = {tether_anchors_.get()},
                          .tether_lengths = {tether_lengths_.get()}};
    const host::EventHandle called(limiter_.enqueue(queue_.get(), buffers, parameters_));
}

void OpenClCloth::launch(cl_kernel kernel, const std::string& name, std::size_t count) {
    cl_event event = nullptr;
    check_opencl(clEnqueueNDRangeKernel(queue_.get(), kernel, 1, nullptr, &count, nullptr, 0, nullptr,
                                        profile_ ? &event : nullptr),
                 "launching " + name);
    if (profile_) launches_.emplace_back(name, event);
}

std::vector<KernelTime> OpenClCloth::kernel_times() {
    std::vector<KernelTime> times = limiter_.profile();
    check_opencl(clFinish(queue_.get()), "running kernels");
    for (const auto& [name, event] : launches_) {
        cl_ulong begin = 0, end = 0;
        check_opencl(clGetEventProfilingInfo(event.get(), CL_PROFILING_COMMAND_START, sizeof begin, &begin, nullptr),
                     "profiling " + name);
        check_opencl(clGetEventProfilingInfo(event.get(), CL_PROFILING_COMMAND_END, sizeof end, &end, nullptr),
                     "profiling " + name);
        auto time = std::ranges::find(times, name, &KernelTime::name);
        if (time == times.end()) time = times.insert(time, {.name = name});
        ++time->launches;
        time->seconds += 1e-9 * static_cast<double>(end - begin);
    }
    launches_.clear();
    return times;
}

const Stats& OpenClCloth::wait_for_stats() {
    const host::EventHandle read(limiter_.read_stats(queue_.get(), {&stats_, 1}));
    check_opencl(clFinish(queue_.get()), "running the limiter");
    return stats_;
}

}  // namespace apsl::scenes
