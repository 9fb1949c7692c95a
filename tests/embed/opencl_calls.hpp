// SPDX-License-Identifier: MIT
#pragma once

#include <CL/cl.h>

#include <cstddef>

namespace apsl::test {

/// The program's OpenCL calls since it began. This program defines these entry points itself and hands each call on.
struct OpenClCalls {
    int host_waits = 0;      ///< clFinish, clWaitForEvents
    int blocking_calls = 0;  ///< reads, writes and maps with a blocking flag
    int reads = 0;           ///< clEnqueueReadBuffer, clEnqueueMapBuffer, blocking or not
    int allocations = 0;     ///< clCreateBuffer
    int releases = 0;        ///< clReleaseMemObject
    int commands = 0;        ///< kernels, fills, copies, writes, markers
    int builds = 0;          ///< clBuildProgram
    int binaries = 0;        ///< clCreateProgramWithBinary
    std::size_t allocated_bytes = 0;
};

OpenClCalls opencl_calls();

/// What the program's OpenCL calls answer in place of the truth, until the next call of pretend.
struct Pretence {
    cl_device_info other_device_text = 0;      ///< this text of a device is another one
    cl_platform_info other_platform_text = 0;  ///< this text of a platform is another one
    bool binaries_are_invalid = false;         ///< clCreateProgramWithBinary fails with CL_INVALID_BINARY
    bool no_binaries = false;                  ///< binaries of programs are 0 bytes long
};

void pretend(const Pretence& pretence);

}  // namespace apsl::test
