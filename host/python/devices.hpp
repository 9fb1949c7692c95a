// SPDX-License-Identifier: MIT
#pragma once

#include <CL/cl.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace apsl::python {

struct Device {
    cl_device_id id = nullptr;
    std::string name;
    std::string platform;
    std::string driver;
    bool is_gpu = false;
    std::uint32_t compute_units = 0;
    std::uint64_t memory = 0;  ///< bytes
};

/// The devices of all platforms, platforms by name: the numbers of `apsl devices`. Empty where there is none.
std::vector<Device> devices();

/// The device with that number; without one the first GPU, else the first device.
/// Throws Error: invalid_argument for a number that no device has, unsupported where there is none at all.
cl_device_id choose_device(std::optional<std::size_t> number);

}  // namespace apsl::python
