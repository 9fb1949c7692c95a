// SPDX-License-Identifier: MIT
#pragma once

namespace apsl::python {

/// Once, when the module is loaded: has forks noticed from then on.
void watch_forks();

/// To be called ahead of OpenCL. Throws Error(unsupported) in a process forked from one that had called this, or that
/// had an OpenCL driver in it at all: the drivers' threads stayed there, and a call would wait for them without end.
void enter_opencl();

}  // namespace apsl::python
