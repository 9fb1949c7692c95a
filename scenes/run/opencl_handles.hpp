// SPDX-License-Identifier: MIT
#pragma once

#include "run/input_error.hpp"

#include <CL/cl.h>

#include <memory>
#include <string>
#include <type_traits>

namespace apsl::scenes {

/// Releases an OpenCL handle at the end of its scope.
template <class Handle, cl_int(CL_API_CALL* release)(Handle)>
struct Release {
    void operator()(Handle handle) const { release(handle); }
};
template <class Handle, cl_int(CL_API_CALL* release)(Handle)>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release<Handle, release>>;

using OwnedContext = Owned<cl_context, clReleaseContext>;
using OwnedQueue = Owned<cl_command_queue, clReleaseCommandQueue>;
using OwnedBuffer = Owned<cl_mem, clReleaseMemObject>;
using OwnedEvent = Owned<cl_event, clReleaseEvent>;

/// Throws InputError for a failed call: a device that does not do what it says is a device to change.
inline void check_opencl(cl_int code, const std::string& what_was_done) {
    if (code != CL_SUCCESS) throw InputError("OpenCL: " + what_was_done + " failed with code " + std::to_string(code));
}

}  // namespace apsl::scenes
