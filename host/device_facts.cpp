// SPDX-License-Identifier: MIT
#include "device_facts.hpp"

#include "opencl_info.hpp"

#include <apsl/error.hpp>

#include <cstdio>

namespace apsl::host {
namespace {

template <class Value>
Value fact(cl_device_id device, cl_device_info what, const char* doing) {
    return info<Value>(clGetDeviceInfo, device, what, doing);
}

}  // namespace

DeviceFacts device_facts(cl_device_id device) {
    DeviceFacts facts;
    facts.name = info_text(clGetDeviceInfo, device, CL_DEVICE_NAME, "asking the device for its name");
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
    const std::string version =
        info_text(clGetDeviceInfo, device, CL_DEVICE_VERSION, "asking the device for its version");
    std::sscanf(version.c_str(), "OpenCL %d.%d", &major, &minor);
    if (major * 10 + minor < 12)
        throw Error(ErrorCode::unsupported, "device " + facts.name + " offers " + version + ", expected OpenCL 1.2");
    return facts;
}

}  // namespace apsl::host
