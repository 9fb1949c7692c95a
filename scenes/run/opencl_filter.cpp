// SPDX-License-Identifier: MIT
#include "run/opencl_filter.hpp"

#include "run/rest_shapes.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

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

std::vector<float> to_float(const std::vector<double>& values) {
    return {values.begin(), values.end()};
}

// Of positions, m: where to lay the origin. The filter looks at differences alone, and 32 bits hold those of a cloth
// far from the origin badly: of 1 km they resolve 0.06 mm. Nearby the origin stays, and so does every bit.
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

}  // namespace

OpenClFilter::OpenClFilter(const OpenClDevice& device, const ClothState& cloth, const StrainLimiting& settings,
                           bool profile)
    : device_name_(device.name),
      parameters_(settings.parameters),
      context_(make_context(device.id)),
      queue_(make_queue(context_.get(), device.id, profile)),
      limiter_(context_.get(), device.id, cloth.topology, settings.options),
      filtered_velocities_(cloth.velocities.size()) {
    uploaded_positions_ = to_float_around(origin_for(cloth.positions), cloth.positions);
    uploaded_velocities_ = to_float(cloth.velocities);
    positions_ = make_buffer(uploaded_positions_, "positions");
    velocities_ = make_buffer(uploaded_velocities_, "velocities");
    inverse_masses_ = make_buffer(to_float(cloth.inverse_masses), "inverse masses");
    rest_areas_ = make_buffer(to_float(cloth.rest_areas), "rest areas");
    if (!settings.regularization.empty()) regularization_ = make_buffer(settings.regularization, "regularization");
    if (settings.options.limits_stretch) rest_shapes_ = make_buffer(to_float(rest_shapes(cloth)), "rest shapes");
    if (!settings.stretch_ceilings.empty())
        stretch_ceilings_ = make_buffer(settings.stretch_ceilings, "stretch ceilings");
    limiter_.set_profiling(profile);
}

host::BufferHandle OpenClFilter::make_buffer(const std::vector<float>& values, const std::string& name) {
    cl_int code = CL_SUCCESS;
    const std::size_t bytes = values.size() * sizeof(float);
    // CL_MEM_COPY_HOST_PTR only reads what it is given.
    host::BufferHandle buffer(clCreateBuffer(context_.get(), CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, bytes,
                                             const_cast<float*>(values.data()), &code));
    check_opencl(code, "allocating " + std::to_string(bytes) + " bytes of " + name);
    buffer_bytes_ += bytes;
    return buffer;
}

std::size_t OpenClFilter::device_bytes() const {
    return limiter_.scratch_bytes() + buffer_bytes_;
}

Stats OpenClFilter::filter(ClothState& cloth) {
    const std::size_t bytes = cloth.positions.size() * sizeof(float);
    uploaded_positions_ = to_float_around(origin_for(cloth.positions), cloth.positions);
    uploaded_velocities_ = to_float(cloth.velocities);
    check_opencl(clEnqueueWriteBuffer(queue_.get(), positions_.get(), CL_FALSE, 0, bytes, uploaded_positions_.data(), 0,
                                      nullptr, nullptr),
                 "uploading positions");
    check_opencl(clEnqueueWriteBuffer(queue_.get(), velocities_.get(), CL_FALSE, 0, bytes, uploaded_velocities_.data(),
                                      0, nullptr, nullptr),
                 "uploading velocities");

    const Buffers buffers{.positions = {positions_.get()},
                          .velocities = {velocities_.get()},
                          .inverse_masses = {inverse_masses_.get()},
                          .rest_areas = {rest_areas_.get()},
                          .regularization = {regularization_.get()},
                          .rest_shapes = {rest_shapes_.get()},
                          .stretch_ceilings = {stretch_ceilings_.get()}};
    const host::EventHandle filtered(limiter_.enqueue(queue_.get(), buffers, parameters_));
    const host::EventHandle read(limiter_.read_stats(queue_.get(), {&stats_, 1}));
    // The queue is in order: this read waits for all of the above.
    check_opencl(clEnqueueReadBuffer(queue_.get(), velocities_.get(), CL_TRUE, 0, bytes, filtered_velocities_.data(), 0,
                                     nullptr, nullptr),
                 "reading velocities");

    // Only the filter's correction goes into the 64-bit velocities, not the rounding of the rest to 32 bits.
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
        if (cloth.inverse_masses[v] == 0.0) continue;
        for (std::size_t k = 3 * v; k < 3 * v + 3; ++k)
            cloth.velocities[k] += static_cast<double>(filtered_velocities_[k]) - uploaded_velocities_[k];
    }
    return stats_;
}

}  // namespace apsl::scenes
