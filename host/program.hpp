// SPDX-License-Identifier: MIT
#pragma once

#include "handles.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace apsl::host {

/// One source text from files of kernels/, their #include "…" lines replaced by the file (once each), with #line so
/// that a build log names the real file.
std::string program_source(std::span<const std::string_view> files);

/// Compiles. Throws Error(kernel_build) with the build log and its first error in the message.
ProgramHandle build_program(cl_context context, cl_device_id device, const std::string& source,
                            const std::string& build_options);

/// From the driver's own bytes. Empty where the driver does not take them.
ProgramHandle load_program(cl_context context, cl_device_id device, std::span<const std::byte> driver_binary,
                           const std::string& build_options);

/// The driver's bytes of a built program for the device; none where the driver keeps none, or where asking for them
/// might end the process.
std::vector<std::byte> driver_binary(cl_program program, cl_device_id device);

}  // namespace apsl::host
