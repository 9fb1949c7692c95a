// SPDX-License-Identifier: MIT
#pragma once

#include "host/opencl_devices.hpp"

#include <optional>

namespace apsl::scenes {

using host::OpenClDevice;

/// host::opencl_devices(). Throws InputError where there is none, saying what to install.
std::vector<OpenClDevice> opencl_devices();

/// The device with that number, else host::default_device(). Throws InputError for a number that no device has.
OpenClDevice choose_opencl_device(std::optional<int> number);

}  // namespace apsl::scenes
