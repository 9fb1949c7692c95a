// SPDX-License-Identifier: MIT
#pragma once

#include <CL/cl.h>

#include <cstdint>
#include <string>
#include <vector>

namespace apsl::host {

struct OpenClDevice {
    cl_device_id id = nullptr;
    std::string name;
    std::string platform;
    std::string driver;
    bool is_gpu = false;
    bool is_cpu = false;
    std::uint32_t compute_units = 0;
    std::uint64_t memory = 0;  ///< bytes
};

/// The devices of all platforms: platforms by name, the devices of each as it gives them. Their places here are the
/// numbers of `apsl devices` and of Python's apsl.devices(). Empty where there is none. Throws Error(opencl).
std::vector<OpenClDevice> opencl_devices();

/// What runs where nobody chose: the first GPU, else the first device. `devices` must not be empty.
const OpenClDevice& default_device(const std::vector<OpenClDevice>& devices);

}  // namespace apsl::host
