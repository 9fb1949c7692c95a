// SPDX-License-Identifier: MIT
#include "run/opencl_devices.hpp"

#include "run/input_error.hpp"

namespace apsl::scenes {

std::vector<OpenClDevice> opencl_devices() {
    std::vector<OpenClDevice> devices = host::opencl_devices();
    if (devices.empty())
        throw InputError(
            "no OpenCL device found: install pocl-opencl-icd (runs on any processor) or your graphics card's OpenCL "
            "driver, or use --backend reference");
    return devices;
}

OpenClDevice choose_opencl_device(std::optional<int> number) {
    const std::vector<OpenClDevice> devices = opencl_devices();
    if (!number) return host::default_device(devices);
    if (*number < 0 || static_cast<std::size_t>(*number) >= devices.size())
        throw InputError("--device " + std::to_string(*number) + ": no such device, expected 0 to " +
                         std::to_string(devices.size() - 1) + " (see apsl devices)");
    return devices[static_cast<std::size_t>(*number)];
}

}  // namespace apsl::scenes
