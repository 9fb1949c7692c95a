// SPDX-License-Identifier: MIT
#include "embed/opencl_calls.hpp"

#include <CL/cl.h>
#include <dlfcn.h>
#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace {

apsl::test::OpenClCalls calls;
apsl::test::Pretence pretended;
apsl::test::CallHooks hooks;
int calls_to_failure = 0;

/// The ICD loader's own definition of the function.
template <class Function>
Function* real(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

/// The text's last letter changed.
void alter(void* text, size_t size) {
    if (text && size > 1) static_cast<char*>(text)[size - 2] ^= 1;
}

void count_blocking(cl_bool blocking) {
    if (!blocking) return;
    if (hooks.before_wait) hooks.before_wait();
    ++calls.blocking_calls;
}

bool fails() {
    return calls_to_failure > 0 && --calls_to_failure == 0;
}

/// `create(status)` makes an object; `status` may be null, as in OpenCL.
template <class Create>
auto created(int& held, cl_int* status, const Create& create) -> decltype(create(status)) {
    if (fails()) {
        if (status) *status = CL_OUT_OF_RESOURCES;
        return nullptr;
    }
    const auto object = create(status);
    held += object ? 1 : 0;
    return object;
}

template <class Enqueue>
cl_int enqueued(cl_event* event, const Enqueue& enqueue) {
    if (fails()) return CL_OUT_OF_RESOURCES;
    const cl_int status = enqueue();
    calls.held.events += event && status == CL_SUCCESS ? 1 : 0;
    return status;
}

/// Whether the build for one of the program's devices logged a warning.
bool warned(cl_program program) {
    cl_uint count = 0;
    clGetProgramInfo(program, CL_PROGRAM_NUM_DEVICES, sizeof(count), &count, nullptr);
    std::vector<cl_device_id> devices(count);
    clGetProgramInfo(program, CL_PROGRAM_DEVICES, count * sizeof(cl_device_id), devices.data(), nullptr);
    return std::any_of(devices.begin(), devices.end(), [program](cl_device_id device) {
        std::size_t size = 0;
        clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size);
        std::string log(size, '\0');
        clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, size, log.data(), nullptr);
        return log.find("warning") != std::string::npos;
    });
}

cl_int counted(int& held, int change, cl_int status) {
    if (status == CL_SUCCESS) held += change;
    return status;
}

}  // namespace

apsl::test::OpenClCalls apsl::test::opencl_calls() {
    return calls;
}

void apsl::test::pretend(const Pretence& pretence) {
    pretended = pretence;
}

void apsl::test::set_call_hooks(const CallHooks& wanted) {
    hooks = wanted;
}

void apsl::test::fail_opencl_call(int number) {
    calls_to_failure = number;
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
    if (what == CL_EVENT_COMMAND_EXECUTION_STATUS) ++calls.polls;
    return next(event, what, size, value, needed);
}

SHOWN cl_command_queue clCreateCommandQueue(cl_context context, cl_device_id device,
                                            cl_command_queue_properties properties, cl_int* status) {
    static auto* const next = real<decltype(clCreateCommandQueue)>("clCreateCommandQueue");
    return created(calls.held.queues, status, [&](cl_int* s) { return next(context, device, properties, s); });
}

SHOWN cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void* host, cl_int* status) {
    static auto* const next = real<decltype(clCreateBuffer)>("clCreateBuffer");
    const cl_mem buffer =
        created(calls.held.buffers, status, [&](cl_int* s) { return next(context, flags, size, host, s); });
    if (buffer) {
        ++calls.allocations;
        calls.allocated_bytes += size;
    }
    return buffer;
}

SHOWN cl_mem clCreateSubBuffer(cl_mem buffer, cl_mem_flags flags, cl_buffer_create_type type, const void* region,
                               cl_int* status) {
    static auto* const next = real<decltype(clCreateSubBuffer)>("clCreateSubBuffer");
    return created(calls.held.buffers, status, [&](cl_int* s) { return next(buffer, flags, type, region, s); });
}

SHOWN cl_program clCreateProgramWithSource(cl_context context, cl_uint count, const char** texts, const size_t* lengths,
                                           cl_int* status) {
    static auto* const next = real<decltype(clCreateProgramWithSource)>("clCreateProgramWithSource");
    return created(calls.held.programs, status, [&](cl_int* s) { return next(context, count, texts, lengths, s); });
}

SHOWN cl_kernel clCreateKernel(cl_program program, const char* name, cl_int* status) {
    static auto* const next = real<decltype(clCreateKernel)>("clCreateKernel");
    return created(calls.held.kernels, status, [&](cl_int* s) { return next(program, name, s); });
}

SHOWN cl_event clCreateUserEvent(cl_context context, cl_int* status) {
    static auto* const next = real<decltype(clCreateUserEvent)>("clCreateUserEvent");
    return created(calls.held.events, status, [&](cl_int* s) { return next(context, s); });
}

SHOWN cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id* devices, const char* options,
                            void(CL_CALLBACK* notify)(cl_program, void*), void* user) {
    static auto* const next = real<decltype(clBuildProgram)>("clBuildProgram");
    ++calls.builds;
    if (fails()) return CL_OUT_OF_RESOURCES;
    const cl_int status = next(program, count, devices, options, notify, user);
    if (status == CL_SUCCESS && warned(program)) ++calls.warned_builds;
    return status;
}

#define COUNT_RETAIN_AND_RELEASE(Name, type, kind)                                    \
    SHOWN cl_int clRetain##Name(type object) {                                        \
        static auto* const next = real<decltype(clRetain##Name)>("clRetain" #Name);   \
        return counted(calls.held.kind, 1, next(object));                             \
    }                                                                                 \
    SHOWN cl_int clRelease##Name(type object) {                                       \
        static auto* const next = real<decltype(clRelease##Name)>("clRelease" #Name); \
        return counted(calls.held.kind, -1, next(object));                            \
    }

COUNT_RETAIN_AND_RELEASE(CommandQueue, cl_command_queue, queues)
COUNT_RETAIN_AND_RELEASE(Program, cl_program, programs)
COUNT_RETAIN_AND_RELEASE(Kernel, cl_kernel, kernels)
COUNT_RETAIN_AND_RELEASE(Event, cl_event, events)

SHOWN cl_int clRetainMemObject(cl_mem object) {
    static auto* const next = real<decltype(clRetainMemObject)>("clRetainMemObject");
    return counted(calls.held.buffers, 1, next(object));
}

SHOWN cl_int clReleaseMemObject(cl_mem object) {
    static auto* const next = real<decltype(clReleaseMemObject)>("clReleaseMemObject");
    ++calls.releases;
    return counted(calls.held.buffers, -1, next(object));
}

SHOWN cl_program clCreateProgramWithBinary(cl_context context, cl_uint count, const cl_device_id* devices,
                                           const size_t* lengths, const unsigned char** binaries, cl_int* statuses,
                                           cl_int* status) {
    static auto* const next = real<decltype(clCreateProgramWithBinary)>("clCreateProgramWithBinary");
    ++calls.binaries;
    if (!pretended.binaries_are_invalid)
        return created(calls.held.programs, status, [&](cl_int* outcome) {
            return next(context, count, devices, lengths, binaries, statuses, outcome);
        });
    *status = CL_INVALID_BINARY;
    return nullptr;
}

SHOWN cl_int clGetProgramInfo(cl_program program, cl_program_info what, size_t size, void* value, size_t* value_size) {
    static auto* const next = real<decltype(clGetProgramInfo)>("clGetProgramInfo");
    if (what == CL_PROGRAM_BINARY_SIZES || what == CL_PROGRAM_BINARIES) ++calls.binary_queries;
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
    if (what == CL_PLATFORM_VERSION && pretended.platform_version) {
        const std::string_view version = pretended.platform_version;
        if (value && size > version.size()) std::memcpy(value, version.data(), version.size() + 1);
        if (value_size) *value_size = version.size() + 1;
        return CL_SUCCESS;
    }
    const cl_int status = next(platform, what, size, value, value_size);
    if (what == pretended.other_platform_text) alter(value, size);
    return status;
}

SHOWN cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset, size_t size,
                                 void* to, cl_uint count, const cl_event* waits, cl_event* event) {
    static auto* const next = real<decltype(clEnqueueReadBuffer)>("clEnqueueReadBuffer");
    ++calls.reads;
    count_blocking(blocking);
    return enqueued(event, [&] { return next(queue, buffer, blocking, offset, size, to, count, waits, event); });
}

SHOWN void* clEnqueueMapBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, cl_map_flags flags,
                               size_t offset, size_t size, cl_uint count, const cl_event* waits, cl_event* event,
                               cl_int* status) {
    static auto* const next = real<decltype(clEnqueueMapBuffer)>("clEnqueueMapBuffer");
    ++calls.reads;
    count_blocking(blocking);
    void* const mapped = next(queue, buffer, blocking, flags, offset, size, count, waits, event, status);
    calls.held.events += event && mapped ? 1 : 0;
    return mapped;
}

SHOWN cl_int clEnqueueWriteBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset, size_t size,
                                  const void* from, cl_uint count, const cl_event* waits, cl_event* event) {
    static auto* const next = real<decltype(clEnqueueWriteBuffer)>("clEnqueueWriteBuffer");
    ++calls.commands;
    count_blocking(blocking);
    return enqueued(event, [&] { return next(queue, buffer, blocking, offset, size, from, count, waits, event); });
}

SHOWN cl_int clEnqueueFillBuffer(cl_command_queue queue, cl_mem buffer, const void* pattern, size_t pattern_size,
                                 size_t offset, size_t size, cl_uint count, const cl_event* waits, cl_event* event) {
    static auto* const next = real<decltype(clEnqueueFillBuffer)>("clEnqueueFillBuffer");
    ++calls.commands;
    return enqueued(event,
                    [&] { return next(queue, buffer, pattern, pattern_size, offset, size, count, waits, event); });
}

SHOWN cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t* offset,
                                    const size_t* global, const size_t* local, cl_uint count, const cl_event* waits,
                                    cl_event* event) {
    static auto* const next = real<decltype(clEnqueueNDRangeKernel)>("clEnqueueNDRangeKernel");
    if (hooks.before_kernel) hooks.before_kernel(queue);
    ++calls.commands;
    return enqueued(event, [&] { return next(queue, kernel, dimensions, offset, global, local, count, waits, event); });
}

SHOWN cl_int clEnqueueMarkerWithWaitList(cl_command_queue queue, cl_uint count, const cl_event* waits,
                                         cl_event* event) {
    static auto* const next = real<decltype(clEnqueueMarkerWithWaitList)>("clEnqueueMarkerWithWaitList");
    ++calls.commands;
    return enqueued(event, [&] { return next(queue, count, waits, event); });
}

}  // extern "C"
