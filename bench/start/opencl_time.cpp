// SPDX-License-Identifier: MIT
#include "opencl_time.hpp"

#include <CL/cl.h>

#include <dlfcn.h>
#include <chrono>

namespace {

apsl::bench::OpenClTime spent;

/// The next definition of the entry point after this program's own: the OpenCL library's.
template <class Function, class... Arguments>
auto timed(double& seconds, const char* name, Arguments... arguments) {
    const auto next = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
    const auto begin = std::chrono::steady_clock::now();
    const auto result = next(arguments...);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return result;
}

}  // namespace

namespace apsl::bench {

OpenClTime opencl_time() {
    return spent;
}

}  // namespace apsl::bench

// Shown, so that a shared library too calls these.
#pragma GCC visibility push(default)
extern "C" {

cl_program CL_API_CALL clCreateProgramWithSource(cl_context context, cl_uint count, const char** strings,
                                                 const size_t* lengths, cl_int* status) {
    return timed<decltype(clCreateProgramWithSource)>(spent.programs, "clCreateProgramWithSource", context, count,
                                                      strings, lengths, status);
}

cl_program CL_API_CALL clCreateProgramWithBinary(cl_context context, cl_uint count, const cl_device_id* devices,
                                                 const size_t* lengths, const unsigned char** binaries,
                                                 cl_int* binary_status, cl_int* status) {
    return timed<decltype(clCreateProgramWithBinary)>(spent.programs, "clCreateProgramWithBinary", context, count,
                                                      devices, lengths, binaries, binary_status, status);
}

cl_int CL_API_CALL clBuildProgram(cl_program program, cl_uint count, const cl_device_id* devices, const char* options,
                                  void(CL_CALLBACK* notify)(cl_program, void*), void* data) {
    return timed<decltype(clBuildProgram)>(spent.programs, "clBuildProgram", program, count, devices, options, notify,
                                           data);
}

cl_kernel CL_API_CALL clCreateKernel(cl_program program, const char* name, cl_int* status) {
    return timed<decltype(clCreateKernel)>(spent.kernels, "clCreateKernel", program, name, status);
}

cl_mem CL_API_CALL clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void* host, cl_int* status) {
    return timed<decltype(clCreateBuffer)>(spent.buffers, "clCreateBuffer", context, flags, size, host, status);
}
}
#pragma GCC visibility pop
