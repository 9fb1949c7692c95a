// SPDX-License-Identifier: MIT
#pragma once

#include "results.hpp"

#include <CL/cl.h>

#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace apsl::bench {

template <class Handle, cl_int(CL_API_CALL* release)(Handle)>
struct Release {
    void operator()(Handle handle) const { release(handle); }
};
template <class Handle, cl_int(CL_API_CALL* release)(Handle)>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release<Handle, release>>;

using OwnedContext = Owned<cl_context, clReleaseContext>;
using OwnedQueue = Owned<cl_command_queue, clReleaseCommandQueue>;
using OwnedBuffer = Owned<cl_mem, clReleaseMemObject>;
using OwnedProgram = Owned<cl_program, clReleaseProgram>;
using OwnedKernel = Owned<cl_kernel, clReleaseKernel>;

/// Throws std::runtime_error for a failed call.
void check(cl_int status, const char* what_was_done);

/// The OpenCL device all of a run is measured on.
struct Device {
    cl_device_id id = nullptr;
    bool is_cpu = false;
    OwnedContext context;
    OwnedQueue queue;            ///< in order, for wall time
    OwnedQueue profiling_queue;  ///< in order, for profiling events
    Place place;                 ///< its copy bandwidth is measured later

    OwnedBuffer buffer(std::size_t bytes, const void* contents = nullptr) const;
    OwnedBuffer upload(const std::vector<float>& contents) const {
        return buffer(contents.size() * sizeof(float), contents.data());
    }
};

/// The device with that number on the first platform whose name contains `platform`.
/// Throws std::runtime_error where there is none, naming the platforms there are.
Device open_device(const std::string& platform, std::size_t number);

}  // namespace apsl::bench
