// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/strain_limiter.hpp>

#include <cstddef>
#include <span>

// What a caller hands over, looked at before anything is built or queued: drivers accept some of what they cannot use,
// or end the process over it. All of these throw Error(invalid_argument) that names the object, opencl where it cannot
// be asked.
namespace apsl::host {

/// Not null, and the device is one of the context's.
void check_device(cl_context context, cl_device_id device);

/// What the kernels do with a buffer.
enum class Access { read, read_and_write, write };

/// A buffer of the context that may be used so, with room for `floats` from the offset on.
void check_view(const BufferView& view, std::size_t floats, Access access, cl_context context, const char* name);

/// A buffer of the context, itself no sub-buffer, that both host and device may read and write.
void check_scratch(const BufferView& scratch, cl_context context);

/// A queue of the context and device, and events of the context.
void check_queue(cl_command_queue queue, std::span<const cl_event> wait_list, cl_context context, cl_device_id device);

/// Parameters for each of the cloths, or one set for all of them.
void check_parameter_count(std::size_t count, std::size_t cloths);

}  // namespace apsl::host
