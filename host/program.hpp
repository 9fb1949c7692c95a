// SPDX-License-Identifier: MIT
#pragma once

#include "handles.hpp"

#include <span>
#include <string>
#include <string_view>

namespace apsl::host {

/// One source text from files of kernels/, their #include "…" lines replaced by the file (once each), with #line so
/// that a build log names the real file.
std::string program_source(std::span<const std::string_view> files);

/// Compiles. Throws Error(kernel_build) with the build log and its first error in the message.
ProgramHandle build_program(cl_context context, cl_device_id device, const std::string& source,
                            const std::string& build_options);

}  // namespace apsl::host
