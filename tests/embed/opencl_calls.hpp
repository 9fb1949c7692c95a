// SPDX-License-Identifier: MIT
#pragma once

#include <CL/cl.h>

#include <cstddef>

namespace apsl::test {

/// References to OpenCL objects that this program holds: those it created or retained less those it released.
struct OpenClReferences {
    int queues = 0;
    int buffers = 0;
    int programs = 0;
    int kernels = 0;
    int events = 0;  ///< those that an enqueue handed out included

    friend bool operator==(const OpenClReferences&, const OpenClReferences&) = default;
};

/// The program's OpenCL calls since it began. This program defines these entry points itself and hands each call on.
struct OpenClCalls {
    int host_waits = 0;      ///< clFinish, clWaitForEvents
    int polls = 0;           ///< clGetEventInfo for how far a command is
    int blocking_calls = 0;  ///< reads, writes and maps with a blocking flag
    int reads = 0;           ///< clEnqueueReadBuffer, clEnqueueMapBuffer, blocking or not
    int allocations = 0;     ///< clCreateBuffer
    int releases = 0;        ///< clReleaseMemObject
    int commands = 0;        ///< kernels, fills, copies, writes, markers
    int builds = 0;          ///< clBuildProgram
    int warned_builds = 0;   ///< those of them whose log has a warning
    int binaries = 0;        ///< clCreateProgramWithBinary
    int binary_queries = 0;  ///< clGetProgramInfo for a program's binaries or their sizes
    std::size_t allocated_bytes = 0;
    OpenClReferences held;
};

OpenClCalls opencl_calls();

/// What the program's OpenCL calls answer in place of the truth, until the next call of pretend.
struct Pretence {
    cl_device_info other_device_text = 0;      ///< this text of a device is another one
    cl_platform_info other_platform_text = 0;  ///< this text of a platform is another one
    const char* platform_version = nullptr;    ///< CL_PLATFORM_VERSION in place of the true one
    bool binaries_are_invalid = false;         ///< clCreateProgramWithBinary fails with CL_INVALID_BINARY
    bool no_binaries = false;                  ///< binaries of programs are 0 bytes long
};

void pretend(const Pretence& pretence);

/// Called in front of the calls they are named after; null where nothing is to be done.
struct CallHooks {
    void (*before_wait)() = nullptr;  ///< what host_waits and blocking_calls count
    void (*before_kernel)(cl_command_queue) = nullptr;
};

void set_call_hooks(const CallHooks& hooks);

/// The `number`-th call from now, from 1, that creates an object, builds or enqueues fails with CL_OUT_OF_RESOURCES,
/// and is not handed on; those after it do as always. 0: none fails.
void fail_opencl_call(int number);

}  // namespace apsl::test
