// SPDX-License-Identifier: MIT
#pragma once

namespace apsl::python {

/// To be called ahead of OpenCL. Throws Error(unsupported) in a process forked from one that had called this: the
/// drivers' threads stayed there, and a call would wait for them without end.
void enter_opencl();

/// Whether enter_opencl would throw.
bool forked_from_opencl();

}  // namespace apsl::python
