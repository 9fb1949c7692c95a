// SPDX-License-Identifier: MIT
#include "devices.hpp"

#include "process.hpp"

#include <apsl/error.hpp>

namespace apsl::python {

std::vector<host::OpenClDevice> devices() {
    enter_opencl();
    return host::opencl_devices();
}

cl_device_id choose_device(std::optional<std::size_t> wanted) {
    const std::vector<host::OpenClDevice> all = devices();
    if (all.empty())
        throw Error(ErrorCode::unsupported,
                    "no OpenCL device found: install pocl-opencl-icd (runs on any processor) or your graphics card's "
                    "OpenCL driver");
    if (!wanted) return host::default_device(all).id;
    if (*wanted >= all.size())
        throw Error(ErrorCode::invalid_argument, "device: got " + std::to_string(*wanted) + ", expected 0 to " +
                                                     std::to_string(all.size() - 1) + " (see apsl.devices())");
    return all[*wanted].id;
}

}  // namespace apsl::python
