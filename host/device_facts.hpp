// SPDX-License-Identifier: MIT
#pragma once

#include <CL/cl.h>

#include <cstdint>
#include <string>

namespace apsl::host {

/// What the limiter's choices depend on. Asked for, never assumed.
struct DeviceFacts {
    std::string name;
    bool is_cpu = false;
    std::uint32_t compute_units = 1;
    std::size_t max_work_group_size = 1;
    std::uint64_t max_allocation = 0;  ///< bytes
};

/// Throws Error: opencl where a query fails; unsupported for a device without a compiler, with big-endian memory or
/// below OpenCL 1.2.
DeviceFacts device_facts(cl_device_id device);

}  // namespace apsl::host
