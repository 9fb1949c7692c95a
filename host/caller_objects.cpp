// SPDX-License-Identifier: MIT
#include "caller_objects.hpp"

#include "invalid.hpp"
#include "opencl_info.hpp"

#include <apsl/error.hpp>

#include <algorithm>
#include <vector>

namespace apsl::host {
namespace {

// Messages are put together where something is wrong, and only there: a call makes these checks anew.
using apsl::invalid;

[[noreturn]] void invalid(const char* name, const std::string& what) {
    invalid(std::string(name) + ' ' + what);
}

template <class Value>
Value buffer_info(cl_mem buffer, cl_mem_info what) {
    return info<Value>(clGetMemObjectInfo, buffer, what, "asking a buffer for its properties");
}

void check_buffer(cl_mem buffer, cl_context context, const char* name) {
    if (!buffer) invalid(name, "is null");
    if (buffer_info<cl_mem_object_type>(buffer, CL_MEM_TYPE) != CL_MEM_OBJECT_BUFFER)
        invalid(name, "is an image or a pipe, expected a buffer");
    if (buffer_info<cl_context>(buffer, CL_MEM_CONTEXT) != context)
        invalid(name, "is of another context, expected the limiter's");
}

void check_offset(const BufferView& view, const char* name) {
    if (view.offset % sizeof(float) != 0)
        invalid(name, "has offset " + std::to_string(view.offset) + ", expected a multiple of 4 bytes");
}

std::string device_name(cl_device_id device) {
    std::size_t size = 0;
    if (clGetDeviceInfo(device, CL_DEVICE_NAME, 0, nullptr, &size) != CL_SUCCESS) return "unknown";
    std::string name(size, '\0');
    clGetDeviceInfo(device, CL_DEVICE_NAME, size, name.data(), nullptr);
    return name.c_str();
}

}  // namespace

void check_device(cl_context context, cl_device_id device) {
    if (!context) invalid("context is null");
    if (!device) invalid("device is null");
    const char* doing = "asking the context for its devices";
    std::size_t size = 0;
    check(clGetContextInfo(context, CL_CONTEXT_DEVICES, 0, nullptr, &size), doing);
    std::vector<cl_device_id> devices(size / sizeof(cl_device_id));
    check(clGetContextInfo(context, CL_CONTEXT_DEVICES, size, devices.data(), nullptr), doing);
    if (std::ranges::find(devices, device) == devices.end())
        invalid("device " + device_name(device) + " is not in the context, expected one of its " +
                std::to_string(devices.size()));
}

void check_view(const BufferView& view, std::size_t floats, Access access, cl_context context, const char* name) {
    check_buffer(view.buffer, context, name);
    // A sub-buffer answers with what it has of its buffer.
    const auto flags = buffer_info<cl_mem_flags>(view.buffer, CL_MEM_FLAGS);
    if (access != Access::read && (flags & CL_MEM_READ_ONLY))
        invalid(name, "is CL_MEM_READ_ONLY, expected a buffer that kernels may write");
    if (access != Access::write && (flags & CL_MEM_WRITE_ONLY))
        invalid(name, "is CL_MEM_WRITE_ONLY, expected a buffer that kernels may read");
    check_offset(view, name);
    const auto size = buffer_info<std::size_t>(view.buffer, CL_MEM_SIZE);
    const std::size_t needed = floats * sizeof(float);
    // Subtracted rather than added: an offset near the end of the range must not wrap round.
    if (view.offset > size || size - view.offset < needed)
        invalid(name, "holds " + std::to_string(size) + " bytes, expected at least " + std::to_string(needed) +
                          " from offset " + std::to_string(view.offset) + " on");
}

void check_scratch(const BufferView& scratch, cl_context context) {
    const char* name = "scratch";
    check_buffer(scratch.buffer, context, name);
    if (buffer_info<cl_mem>(scratch.buffer, CL_MEM_ASSOCIATED_MEMOBJECT))
        invalid(name, "is a sub-buffer, expected the buffer itself and an offset");
    const auto flags = buffer_info<cl_mem_flags>(scratch.buffer, CL_MEM_FLAGS);
    if (flags & (CL_MEM_READ_ONLY | CL_MEM_WRITE_ONLY))
        invalid(name, "is CL_MEM_READ_ONLY or CL_MEM_WRITE_ONLY, expected CL_MEM_READ_WRITE");
    // The adjacency is uploaded there, and the statistics are read from there.
    if (flags & (CL_MEM_HOST_READ_ONLY | CL_MEM_HOST_WRITE_ONLY | CL_MEM_HOST_NO_ACCESS))
        invalid(name, "has a CL_MEM_HOST_ flag, expected memory that the host may read and write");
    check_offset(scratch, name);
}

void check_queue(cl_command_queue queue, std::span<const cl_event> wait_list, cl_context context, cl_device_id device) {
    if (!queue) invalid("queue is null");
    const char* doing = "asking the queue for its context and device";
    if (info<cl_context>(clGetCommandQueueInfo, queue, CL_QUEUE_CONTEXT, doing) != context)
        invalid("queue is of another context, expected the limiter's");
    const auto of_queue = info<cl_device_id>(clGetCommandQueueInfo, queue, CL_QUEUE_DEVICE, doing);
    if (of_queue != device)
        invalid("queue is on device " + device_name(of_queue) + ", expected the limiter's, " + device_name(device));
    for (std::size_t n = 0; n < wait_list.size(); ++n) {
        const cl_event event = wait_list[n];
        if (!event) invalid("wait_list[" + std::to_string(n) + "] is null");
        if (info<cl_context>(clGetEventInfo, event, CL_EVENT_CONTEXT, "asking an event for its context") != context)
            invalid("wait_list[" + std::to_string(n) + "] is of another context, expected the limiter's");
    }
}

void check_parameter_count(std::size_t count, std::size_t cloths) {
    if (count != 1 && count != cloths)
        invalid(std::to_string(count) + " parameters given for " + std::to_string(cloths) +
                " cloths, expected one for each or a single one");
}

}  // namespace apsl::host
