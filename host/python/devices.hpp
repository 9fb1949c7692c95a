// SPDX-License-Identifier: MIT
#pragma once

#include "opencl_devices.hpp"

#include <pybind11/pybind11.h>

#include <optional>

namespace apsl::python {

/// host::opencl_devices(), behind enter_opencl().
std::vector<host::OpenClDevice> devices();

/// Of None, a number, or an object with a `number`: the argument `device`. Throws Error(invalid_argument).
std::optional<std::size_t> device_number(pybind11::handle device);

/// The device with that number, else host::default_device().
/// Throws Error: invalid_argument for a number that no device has, unsupported where there is none at all.
cl_device_id choose_device(std::optional<std::size_t> number);

}  // namespace apsl::python
