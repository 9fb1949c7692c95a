// SPDX-License-Identifier: MIT
#pragma once

#include <CL/cl.h>

#include <string>

namespace apsl::host {

/// The name of an OpenCL status, as the specification spells it.
std::string opencl_status_name(cl_int status);

/// Throws Error(opencl) unless status is CL_SUCCESS. `doing` completes "apsl: … failed with CL_…".
void check(cl_int status, const char* doing);

}  // namespace apsl::host
