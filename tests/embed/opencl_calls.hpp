// SPDX-License-Identifier: MIT
#pragma once

#include <CL/cl.h>

#include <cstddef>

namespace apsl::test {

/// The program's OpenCL calls since it began. This program defines these entry points itself and hands each call on.
struct OpenClCalls {
    int host_waits = 0;      ///< clFinish, clWaitForEvents
    int polls = 0;           ///< clGetEventInfo
    int blocking_calls = 0;  ///< reads, writes and maps with a blocking flag
    int reads = 0;           ///< clEnqueueReadBuffer, clEnqueueMapBuffer, blocking or not
    int allocations = 0;     ///< clCreateBuffer
    int releases = 0;        ///< clReleaseMemObject
    int commands = 0;        ///< kernels, fills, copies, writes, markers
    int builds = 0;          ///< clBuildProgram
    std::size_t allocated_bytes = 0;
};

OpenClCalls opencl_calls();

/// Called in front of the calls they are named after; null where nothing is to be done.
struct CallHooks {
    void (*before_wait)() = nullptr;  ///< what host_waits and blocking_calls count
    void (*before_kernel)(cl_command_queue) = nullptr;
};

void set_call_hooks(const CallHooks& hooks);

}  // namespace apsl::test
