// SPDX-License-Identifier: MIT
#include "run/opencl_devices.hpp"

#include "run/input_error.hpp"
#include "run/opencl_handles.hpp"

#include <algorithm>
#include <utility>

namespace apsl::scenes {
namespace {

constexpr const char* kWhatToInstall =
    "install pocl-opencl-icd (runs on any processor) or your graphics card's OpenCL driver, or use --backend reference";

std::string without_trailing_zeros(std::string text) {
    text.resize(std::min(text.find('\0'), text.size()));
    return text;
}

std::string platform_name(cl_platform_id platform) {
    std::size_t size = 0;
    check_opencl(clGetPlatformInfo(platform, CL_PLATFORM_NAME, 0, nullptr, &size), "clGetPlatformInfo");
    std::string text(size, '\0');
    check_opencl(clGetPlatformInfo(platform, CL_PLATFORM_NAME, size, text.data(), nullptr), "clGetPlatformInfo");
    return without_trailing_zeros(std::move(text));
}

std::string device_text(cl_device_id device, cl_device_info what) {
    std::size_t size = 0;
    check_opencl(clGetDeviceInfo(device, what, 0, nullptr, &size), "clGetDeviceInfo");
    std::string text(size, '\0');
    check_opencl(clGetDeviceInfo(device, what, size, text.data(), nullptr), "clGetDeviceInfo");
    return without_trailing_zeros(std::move(text));
}

template <class Number>
Number device_number(cl_device_id device, cl_device_info what) {
    Number number{};
    check_opencl(clGetDeviceInfo(device, what, sizeof number, &number, nullptr), "clGetDeviceInfo");
    return number;
}

std::vector<std::pair<std::string, cl_platform_id>> platforms_by_name() {
    cl_uint count = 0;
    const cl_int code = clGetPlatformIDs(0, nullptr, &count);
    // The ICD loader's own code, CL_PLATFORM_NOT_FOUND_KHR, says the same as a count of 0.
    if (count == 0) throw InputError(std::string("no OpenCL platform found: ") + kWhatToInstall);
    check_opencl(code, "clGetPlatformIDs");
    std::vector<cl_platform_id> platforms(count);
    check_opencl(clGetPlatformIDs(count, platforms.data(), nullptr), "clGetPlatformIDs");

    std::vector<std::pair<std::string, cl_platform_id>> named;
    for (const cl_platform_id platform : platforms) named.emplace_back(platform_name(platform), platform);
    // The loader lists drivers in the order of their files, which differs between machines.
    std::stable_sort(named.begin(), named.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    return named;
}

}  // namespace

std::vector<OpenClDevice> opencl_devices() {
    std::vector<OpenClDevice> devices;
    for (const auto& [platform, platform_id] : platforms_by_name()) {
        cl_uint count = 0;
        const cl_int code = clGetDeviceIDs(platform_id, CL_DEVICE_TYPE_ALL, 0, nullptr, &count);
        if (code == CL_DEVICE_NOT_FOUND || count == 0) continue;
        check_opencl(code, "clGetDeviceIDs");
        std::vector<cl_device_id> ids(count);
        check_opencl(clGetDeviceIDs(platform_id, CL_DEVICE_TYPE_ALL, count, ids.data(), nullptr), "clGetDeviceIDs");
        for (const cl_device_id id : ids) {
            devices.push_back({.id = id,
                               .is_gpu = (device_number<cl_device_type>(id, CL_DEVICE_TYPE) & CL_DEVICE_TYPE_GPU) != 0,
                               .name = device_text(id, CL_DEVICE_NAME),
                               .platform = platform,
                               .driver = device_text(id, CL_DRIVER_VERSION),
                               .compute_units = device_number<cl_uint>(id, CL_DEVICE_MAX_COMPUTE_UNITS),
                               .memory = device_number<cl_ulong>(id, CL_DEVICE_GLOBAL_MEM_SIZE)});
        }
    }
    if (devices.empty()) throw InputError(std::string("no OpenCL device found: ") + kWhatToInstall);
    return devices;
}

OpenClDevice choose_opencl_device(std::optional<int> number) {
    const std::vector<OpenClDevice> devices = opencl_devices();
    if (number) {
        if (*number < 0 || static_cast<std::size_t>(*number) >= devices.size()) {
            throw InputError("--device " + std::to_string(*number) + ": no such device, expected 0 to " +
                             std::to_string(devices.size() - 1) + " (see apsl devices)");
        }
        return devices[static_cast<std::size_t>(*number)];
    }
    const auto gpu = std::find_if(devices.begin(), devices.end(), [](const auto& device) { return device.is_gpu; });
    return gpu == devices.end() ? devices.front() : *gpu;
}

}  // namespace apsl::scenes
