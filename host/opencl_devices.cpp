// SPDX-License-Identifier: MIT
#include "opencl_devices.hpp"

#include "opencl_info.hpp"

#include <algorithm>

namespace apsl::host {
namespace {

constexpr const char* asking = "apsl: asking for a device's properties";

}  // namespace

std::vector<OpenClDevice> opencl_devices() {
    cl_uint platform_count = 0;
    clGetPlatformIDs(0, nullptr, &platform_count);  // the loader calls it an error where there is none
    if (platform_count == 0) return {};
    std::vector<cl_platform_id> platforms(platform_count);
    check(clGetPlatformIDs(platform_count, platforms.data(), nullptr), "apsl: listing the OpenCL platforms");

    std::vector<OpenClDevice> found;
    for (const cl_platform_id platform : platforms) {
        cl_uint count = 0;
        if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &count) != CL_SUCCESS || count == 0) continue;
        std::vector<cl_device_id> ids(count);
        check(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, count, ids.data(), nullptr),
              "apsl: listing a platform's devices");
        for (const cl_device_id id : ids) {
            const auto type = info<cl_device_type>(clGetDeviceInfo, id, CL_DEVICE_TYPE, asking);
            found.push_back({.id = id,
                             .name = info_text(clGetDeviceInfo, id, CL_DEVICE_NAME, asking),
                             .platform = info_text(clGetPlatformInfo, platform, CL_PLATFORM_NAME, asking),
                             .driver = info_text(clGetDeviceInfo, id, CL_DRIVER_VERSION, asking),
                             .is_gpu = (type & CL_DEVICE_TYPE_GPU) != 0,
                             .is_cpu = (type & CL_DEVICE_TYPE_CPU) != 0,
                             .compute_units = info<cl_uint>(clGetDeviceInfo, id, CL_DEVICE_MAX_COMPUTE_UNITS, asking),
                             .memory = info<cl_ulong>(clGetDeviceInfo, id, CL_DEVICE_GLOBAL_MEM_SIZE, asking)});
        }
    }
    // The loader lists platforms in the order of their files, which differs between machines.
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.platform < b.platform; });
    return found;
}

const OpenClDevice& default_device(const std::vector<OpenClDevice>& devices) {
    const auto gpu =
        std::find_if(devices.begin(), devices.end(), [](const OpenClDevice& device) { return device.is_gpu; });
    return gpu == devices.end() ? devices.front() : *gpu;
}

}  // namespace apsl::host
