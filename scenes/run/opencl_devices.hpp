// SPDX-License-Identifier: MIT
#pragma once

#include <CL/cl.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace apsl::scenes {

struct OpenClDevice {
    cl_device_id id = nullptr;
    bool is_gpu = false;
    std::string name;
    std::string platform;
    std::string driver;
    std::uint32_t compute_units = 0;
    std::uint64_t memory = 0;  ///< bytes
};

/// The devices of all platforms, platforms by name and the devices of each as it gives them: the numbers of
/// `apsl devices`. Throws InputError where there is no platform or no device, saying what to install.
std::vector<OpenClDevice> opencl_devices();

/// The device with that number; without one the first GPU, else the first device.
/// Throws InputError for a number that no device has.
OpenClDevice choose_opencl_device(std::optional<int> number);

}  // namespace apsl::scenes
