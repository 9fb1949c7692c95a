// SPDX-License-Identifier: MIT
#pragma once

#include "run/input_error.hpp"

#include <CL/cl.h>

#include <string>

namespace apsl::scenes {

/// Throws InputError for a failed call: a device that does not do what it says is a device to change.
inline void check_opencl(cl_int code, const std::string& what_was_done) {
    if (code != CL_SUCCESS) throw InputError("OpenCL: " + what_was_done + " failed with code " + std::to_string(code));
}

}  // namespace apsl::scenes
