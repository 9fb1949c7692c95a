// SPDX-License-Identifier: MIT
#include "device.hpp"

#include <stdexcept>

namespace apsl::bench {
namespace {

template <class Info, class Id, class Name>
std::string text(Info info, Id id, Name name) {
    std::size_t size = 0;
    check(info(id, name, 0, nullptr, &size), "asking for a name");
    std::string value(size, '\0');
    check(info(id, name, size, value.data(), nullptr), "asking for a name");
    return value.c_str();
}

template <class Value>
Value device_value(cl_device_id id, cl_device_info name) {
    Value value{};
    check(clGetDeviceInfo(id, name, sizeof value, &value, nullptr), "asking the device for a property");
    return value;
}

Device open(cl_device_id id, const std::string& platform) {
    Device device;
    device.id = id;
    device.is_cpu = (device_value<cl_device_type>(id, CL_DEVICE_TYPE) & CL_DEVICE_TYPE_CPU) != 0;
    cl_int status = CL_SUCCESS;
    device.context.reset(clCreateContext(nullptr, 1, &id, nullptr, nullptr, &status));
    check(status, "creating a context");
    device.queue.reset(clCreateCommandQueue(device.context.get(), id, 0, &status));
    check(status, "creating a queue");
    device.profiling_queue.reset(clCreateCommandQueue(device.context.get(), id, CL_QUEUE_PROFILING_ENABLE, &status));
    check(status, "creating a profiling queue");
    device.place.device = text(clGetDeviceInfo, id, CL_DEVICE_NAME);
    device.place.driver = platform + " " + text(clGetDeviceInfo, id, CL_DRIVER_VERSION);
    device.place.threads = static_cast<int>(device_value<cl_uint>(id, CL_DEVICE_MAX_COMPUTE_UNITS));
    return device;
}

}  // namespace

void check(cl_int status, const char* what_was_done) {
    if (status != CL_SUCCESS)
        throw std::runtime_error(std::string("OpenCL: ") + what_was_done + " failed with " + std::to_string(status));
}

OwnedBuffer Device::buffer(std::size_t bytes, const void* contents) const {
    cl_int status = CL_SUCCESS;
    OwnedBuffer buffer(clCreateBuffer(context.get(), CL_MEM_READ_WRITE | (contents ? CL_MEM_COPY_HOST_PTR : 0), bytes,
                                      const_cast<void*>(contents), &status));
    check(status, "allocating device memory");
    return buffer;
}

Device open_device(const std::string& platform, std::size_t number) {
    cl_uint count = 0;
    clGetPlatformIDs(0, nullptr, &count);  // fails where there is none
    std::vector<cl_platform_id> platforms(count);
    if (count > 0) check(clGetPlatformIDs(count, platforms.data(), nullptr), "asking for platforms");
    std::string seen;
    for (const cl_platform_id candidate : platforms) {
        const std::string name = text(clGetPlatformInfo, candidate, CL_PLATFORM_NAME);
        seen += seen.empty() ? name : ", " + name;
        cl_uint devices = 0;
        if (name.find(platform) == std::string::npos ||
            clGetDeviceIDs(candidate, CL_DEVICE_TYPE_ALL, 0, nullptr, &devices) != CL_SUCCESS || number >= devices)
            continue;
        std::vector<cl_device_id> ids(devices);
        check(clGetDeviceIDs(candidate, CL_DEVICE_TYPE_ALL, devices, ids.data(), nullptr), "asking for devices");
        return open(ids[number], name);
    }
    throw std::runtime_error("no OpenCL device " + std::to_string(number) + " on a platform named \"" + platform +
                             "\"; platforms here: " + (seen.empty() ? "none" : seen));
}

}  // namespace apsl::bench
