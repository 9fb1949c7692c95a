// SPDX-License-Identifier: MIT
#include "embed/opencl_calls.hpp"

#include <CL/cl.h>
#include <dlfcn.h>

namespace {

apsl::test::OpenClCalls calls;
apsl::test::CallHooks hooks;

/// The ICD loader's own definition of the function.
template <class Function>
Function* real(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

void count_blocking(cl_bool blocking) {
    if (!blocking) return;
    if (hooks.before_wait) hooks.before_wait();
    ++calls.blocking_calls;
}

}  // namespace

apsl::test::OpenClCalls apsl::test::opencl_calls() {
    return calls;
}

void apsl::test::set_call_hooks(const CallHooks& wanted) {
    hooks = wanted;
}

#define SHOWN __attribute__((visibility("default")))

extern "C" {

SHOWN cl_int clFinish(cl_command_queue queue) {
    static auto* const next = real<decltype(clFinish)>("clFinish");
    if (hooks.before_wait) hooks.before_wait();
    ++calls.host_waits;
    return next(queue);
}

SHOWN cl_int clWaitForEvents(cl_uint count, const cl_event* events) {
    static auto* const next = real<decltype(clWaitForEvents)>("clWaitForEvents");
    if (hooks.before_wait) hooks.before_wait();
    ++calls.host_waits;
    return next(count, events);
}

SHOWN cl_int clGetEventInfo(cl_event event, cl_event_info what, size_t size, void* value, size_t* needed) {
    static auto* const next = real<decltype(clGetEventInfo)>("clGetEventInfo");
    ++calls.polls;
    return next(event, what, size, value, needed);
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

SHOWN cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset, size_t size,
                                 void* to, cl_uint count, const cl_event* waits, cl_event* event) {
    static auto* const next = real<decltype(clEnqueueReadBuffer)>("clEnqueueReadBuffer");
    ++calls.reads;
    count_blocking(blocking);
    return next(queue, buffer, blocking, offset, size, to, count, waits, event);
}

SHOWN void* clEnqueueMapBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, cl_map_flags flags,
                               size_t offset, size_t size, cl_uint count, const cl_event* waits, cl_event* event,
                               cl_int* status) {
    static auto* const next = real<decltype(clEnqueueMapBuffer)>("clEnqueueMapBuffer");
    ++calls.reads;
    count_blocking(blocking);
    return next(queue, buffer, blocking, flags, offset, size, count, waits, event, status);
}

SHOWN cl_int clEnqueueWriteBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset, size_t size,
                                  const void* from, cl_uint count, const cl_event* waits, cl_event* event) {
    static auto* const next = real<decltype(clEnqueueWriteBuffer)>("clEnqueueWriteBuffer");
    ++calls.commands;
    count_blocking(blocking);
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
    if (hooks.before_kernel) hooks.before_kernel(queue);
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
