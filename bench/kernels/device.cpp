// SPDX-License-Identifier: MIT
#include "device.hpp"

#include "host/opencl_devices.hpp"

#include <stdexcept>

namespace apsl::bench {
namespace {

Device open(const host::OpenClDevice& found) {
    const cl_device_id id = found.id;
    Device device;
    device.id = id;
    device.is_cpu = found.is_cpu;
    cl_int status = CL_SUCCESS;
    device.context = host::ContextHandle(clCreateContext(nullptr, 1, &id, nullptr, nullptr, &status));
    check(status, "creating a context");
    device.queue = host::QueueHandle(clCreateCommandQueue(device.context.get(), id, 0, &status));
    check(status, "creating a queue");
    device.profiling_queue =
        host::QueueHandle(clCreateCommandQueue(device.context.get(), id, CL_QUEUE_PROFILING_ENABLE, &status));
    check(status, "creating a profiling queue");
    device.place.device = found.name;
    device.place.driver = found.platform + " " + found.driver;
    device.place.threads = static_cast<int>(found.compute_units);
    return device;
}

}  // namespace

void check(cl_int status, const char* what_was_done) {
    if (status != CL_SUCCESS)
        throw std::runtime_error(std::string("OpenCL: ") + what_was_done + " failed with " + std::to_string(status));
}

host::BufferHandle Device::buffer(std::size_t bytes, const void* contents) const {
    cl_int status = CL_SUCCESS;
    host::BufferHandle buffer(clCreateBuffer(context.get(), CL_MEM_READ_WRITE | (contents ? CL_MEM_COPY_HOST_PTR : 0),
                                             bytes, const_cast<void*>(contents), &status));
    check(status, "allocating device memory");
    return buffer;
}

Device open_device(const std::string& platform, std::size_t number) {
    std::string seen;
    for (const host::OpenClDevice& device : host::opencl_devices()) {
        seen += (seen.empty() ? "" : ", ") + device.platform;
        if (device.platform.find(platform) != std::string::npos && number-- == 0) return open(device);
    }
    throw std::runtime_error("no OpenCL device of that number on a platform named \"" + platform +
                             "\"; devices here are on: " + (seen.empty() ? "none" : seen));
}

}  // namespace apsl::bench
