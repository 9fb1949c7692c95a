// SPDX-License-Identifier: MIT
#pragma once

namespace apsl::bench {

/// Seconds this program has spent so far in the OpenCL calls that a limiter's construction makes. This program defines
/// these entry points itself, hands each call on and adds up its time.
struct OpenClTime {
    double programs = 0.0;  ///< creating and building
    double kernels = 0.0;   ///< clCreateKernel
    double buffers = 0.0;   ///< clCreateBuffer, uploads included
};

OpenClTime opencl_time();

}  // namespace apsl::bench
