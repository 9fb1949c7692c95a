// SPDX-License-Identifier: MIT
#include "device_facts.hpp"

#include "opencl_error.hpp"

#include <apsl/error.hpp>

#include <cstdio>

namespace apsl::host {
namespace {

template <class Value>
Value fact(cl_device_id device, cl_device_info what, const char* doing) {
    Value value{};
    check(clGetDeviceInfo(device, what, sizeof value, &value, nullptr), doing);
    return value;
}

std::string text_fact(cl_device_id device, cl_device_info what, const char* doing) {
    std::size_t size = 0;
    check(clGetDeviceInfo(device, what, 0, nullptr, &size), doing);
    std::string text(size, '\0');
    check(clGetDeviceInfo(device, what, size, text.data(), nullptr), doing);
    while (!text.empty() && text.back() == '\0') text.pop_back();
    return text;
}

}  // namespace

DeviceFacts device_facts(cl_device_id device) {
    DeviceFacts facts;
    facts.name = text_fact(device, CL_DEVICE_NAME, "asking the device for its name");
    facts.is_cpu =
        (fact<cl_device_type>(device, CL_DEVICE_TYPE, "asking the device for its type") & CL_DEVICE_TYPE_CPU) != 0;
    facts.compute_units = fact<cl_uint>(device, CL_DEVICE_MAX_COMPUTE_UNITS, "asking the device for its compute units");
    facts.max_work_group_size =
        fact<std::size_t>(device, CL_DEVICE_MAX_WORK_GROUP_SIZE, "asking the device for its work-group size");
    facts.max_allocation =
        fact<cl_ulong>(device, CL_DEVICE_MAX_MEM_ALLOC_SIZE, "asking the device for its greatest buffer");

    const auto require = [&](bool holds, const char* what) {
        if (!holds) throw Error(ErrorCode::unsupported, "device " + facts.name + " " + what);
    };
    require(fact<cl_bool>(device, CL_DEVICE_COMPILER_AVAILABLE, "asking the device for a compiler"),
            "has no OpenCL C compiler");
    require(fact<cl_bool>(device, CL_DEVICE_ENDIAN_LITTLE, "asking the device for its byte order"),
            "is big-endian, expected little-endian");
    int major = 0, minor = 0;
    const std::string version = text_fact(device, CL_DEVICE_VERSION, "asking the device for its version");
    std::sscanf(version.c_str(), "OpenCL %d.%d", &major, &minor);
    if (major * 10 + minor < 12)
        throw Error(ErrorCode::unsupported, "device " + facts.name + " offers " + version + ", expected OpenCL 1.2");
    return facts;
}

}  // namespace apsl::host
