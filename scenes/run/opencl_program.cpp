// SPDX-License-Identifier: MIT
#include "run/opencl_program.hpp"

#include "pipeline/kernel_sources.hpp"
#include "run/check_opencl.hpp"

#include <algorithm>
#include <string_view>

namespace apsl::scenes {
namespace {

std::string build_log(cl_program program, cl_device_id device) {
    std::size_t size = 0;
    if (clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size) != CL_SUCCESS) return {};
    std::string log(size, '\0');
    clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, size, log.data(), nullptr);
    return log.substr(0, log.find('\n'));
}

}  // namespace

host::KernelHandle make_kernel(cl_context context, cl_device_id device, const std::string& name,
                               const std::string& definitions) {
    const auto sources = kernel_sources();
    const std::string_view text =
        std::ranges::find(sources, name + ".cl", [](const host::KernelSource& source) { return source.name; })->text;
    const char* begin = text.data();
    const std::size_t length = text.size();
    cl_int code = CL_SUCCESS;
    const host::ProgramHandle program(clCreateProgramWithSource(context, 1, &begin, &length, &code));
    check_opencl(code, "clCreateProgramWithSource");
    code = clBuildProgram(program.get(), 1, &device, ("-cl-std=CL1.2" + definitions).c_str(), nullptr, nullptr);
    if (code != CL_SUCCESS)
        throw InputError("OpenCL: compiling " + name + " failed with code " + std::to_string(code) + ": " +
                         build_log(program.get(), device));
    host::KernelHandle kernel(clCreateKernel(program.get(), name.c_str(), &code));
    check_opencl(code, "clCreateKernel " + name);
    return kernel;
}

}  // namespace apsl::scenes
