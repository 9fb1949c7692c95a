// SPDX-License-Identifier: MIT
#include "embed/opencl_calls.hpp"

#include <CL/cl.h>
#include <dlfcn.h>
#include <algorithm>

namespace {

apsl::test::OpenClCalls calls;
apsl::test::Pretence pretended;

/// The ICD loader's own definition of the function.
template <class Function>
Function* real(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

/// The text's last letter changed.
void alter(void* text, size_t size) {
    if (text && size > 1) static_cast<char*>(text)[size - 2] ^= 1;
}

}  // namespace

apsl::test::OpenClCalls apsl::test::opencl_calls() {
    return calls;
}

void apsl::test::pretend(const Pretence& pretence) {
    pretended = pretence;
}

#define SHOWN __attribute__((visibility("default")))

extern "C" {

SHOWN cl_int clFinish(cl_command_queue queue) {
    static auto* const next = real<decltype(clFinish)>("clFinish");
    ++calls.host_waits;
    return next(queue);
}

SHOWN cl_int clWaitForEvents(cl_uint count, const cl_event* events) {
    static auto* const next = real<decltype(clWaitForEvents)>("clWaitForEvents");
    ++calls.host_waits;
    return next(count, events);
}

SHOWN cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void* host, cl_int* status) {
    static auto* const next = real<decltype(clCreateBuffer)>("clCreateBuffer");
    ++calls.allocations;
    calls.allocated_bytes += size;
    return next(context, flags, size, host, status);
}

SHOWN cl_int clReleaseMemObject(cl_mem object) {
    static auto* const next = real<decltype(clReleaseMemObject)>("clReleaseMemObject");
    ++calls.releases;
    return next(object);
}

SHOWN cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id* devices, const char* options,
                            void(CL_CALLBACK* notify)(cl_program, void*), void* user) {
    static auto* const next = real<decltype(clBuildProgram)>("clBuildProgram");
    ++calls.builds;
    return next(program, count, devices, options, notify, user);
}

SHOWN cl_program clCreateProgramWithBinary(cl_context context, cl_uint count, const cl_device_id* devices,
                                           const size_t* lengths, const unsigned char** binaries, cl_int* statuses,
                                           cl_int* status) {
    static auto* const next = real<decltype(clCreateProgramWithBinary)>("clCreateProgramWithBinary");
    ++calls.binaries;
    if (!pretended.binaries_are_invalid) return next(context, count, devices, lengths, binaries, statuses, status);
    *status = CL_INVALID_BINARY;
    return nullptr;
}

SHOWN cl_int clGetProgramInfo(cl_program program, cl_program_info what, size_t size, void* value, size_t* value_size) {
    static auto* const next = real<decltype(clGetProgramInfo)>("clGetProgramInfo");
    const cl_int status = next(program, what, size, value, value_size);
    if (pretended.no_binaries && what == CL_PROGRAM_BINARY_SIZES) std::fill_n(static_cast<char*>(value), size, char{0});
    return status;
}

SHOWN cl_int clGetDeviceInfo(cl_device_id device, cl_device_info what, size_t size, void* value, size_t* value_size) {
    static auto* const next = real<decltype(clGetDeviceInfo)>("clGetDeviceInfo");
    const cl_int status = next(device, what, size, value, value_size);
    if (what == pretended.other_device_text) alter(value, size);
    return status;
}

SHOWN cl_int clGetPlatformInfo(cl_platform_id platform, cl_platform_info what, size_t size, void* value,
                               size_t* value_size) {
    static auto* const next = real<decltype(clGetPlatformInfo)>("clGetPlatformInfo");
    const cl_int status = next(platform, what, size, value, value_size);
    if (what == pretended.other_platform_text) alter(value, size);
    return status;
}

SHOWN cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset, size_t size,
                                 void* to, cl_uint count, const cl_event* waits, cl_event* event) {
    static auto* const next = real<decltype(clEnqueueReadBuffer)>("clEnqueueReadBuffer");
    ++calls.reads;
    calls.blocking_calls += blocking ? 1 : 0;
    return next(queue, buffer, blocking, offset, size, to, count, waits, event);
}

SHOWN void* clEnqueueMapBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, cl_map_flags flags,
                               size_t offset, size_t size, cl_uint count, const cl_event* waits, cl_event* event,
                               cl_int* status) {
    static auto* const next = real<decltype(clEnqueueMapBuffer)>("clEnqueueMapBuffer");
    ++calls.reads;
    calls.blocking_calls += blocking ? 1 : 0;
    return next(queue, buffer, blocking, flags, offset, size, count, waits, event, status);
}

SHOWN cl_int clEnqueueWriteBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset, size_t size,
                                  const void* from, cl_uint count, const cl_event* waits, cl_event* event) {
    static auto* const next = real<decltype(clEnqueueWriteBuffer)>("clEnqueueWriteBuffer");
    ++calls.commands;
    calls.blocking_calls += blocking ? 1 : 0;
    return next(queue, buffer, blocking, offset, size, from, count, waits, event);
}

SHOWN cl_int clEnqueueFillBuffer(cl_command_queue queue, cl_mem buffer, const void* pattern, size_t pattern_size,
                                 size_t offset, size_t size, cl_uint count, const cl_event* waits, cl_event* event) {
    static auto* const next = real<decltype(clEnqueueFillBuffer)>("clEnqueueFillBuffer");
    ++calls.commands;
    return next(queue, buffer, pattern, pattern_size, offset, size, count, waits, event);
}

SHOWN cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t* offset,
                                    const size_t* global, const size_t* local, cl_uint count, const cl_event* waits,
                                    cl_event* event) {
    static auto* const next = real<decltype(clEnqueueNDRangeKernel)>("clEnqueueNDRangeKernel");
    ++calls.commands;
    return next(queue, kernel, dimensions, offset, global, local, count, waits, event);
}

SHOWN cl_int clEnqueueMarkerWithWaitList(cl_command_queue queue, cl_uint count, const cl_event* waits,
                                         cl_event* event) {
    static auto* const next = real<decltype(clEnqueueMarkerWithWaitList)>("clEnqueueMarkerWithWaitList");
    ++calls.commands;
    return next(queue, count, waits, event);
}

}  // extern "C"
