// SPDX-License-Identifier: MIT
#include "program.hpp"

#include "kernel_sources.hpp"
#include "opencl_info.hpp"

#include <apsl/error.hpp>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <set>

namespace apsl::host {
namespace {

std::string_view source_text(std::string_view name) {
    for (const KernelSource& source : kernel_sources())
        if (source.name == name) return source.text;
    throw Error(ErrorCode::kernel_build, "kernel source " + std::string(name) + " is not part of this build");
}

std::string line_directive(std::size_t line, std::string_view name) {
    return "#line " + std::to_string(line) + " \"kernels/" + std::string(name) + "\"\n";
}

void append(std::string& out, std::string_view name, std::set<std::string_view>& included) {
    if (!included.insert(name).second) return;
    constexpr std::string_view directive = "#include \"";
    out += line_directive(1, name);
    std::string_view text = source_text(name);
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
        const std::string_view content = text.substr(0, end);
        text.remove_prefix(end);
        if (content.starts_with(directive)) {
            const std::size_t quote = content.find('"', directive.size());
            append(out, content.substr(directive.size(), quote - directive.size()), included);
            out += line_directive(line + 1, name);
        } else {
            out += content;
        }
    }
    out += '\n';
}

std::string first_error(const std::string& log) {
    if (log.find_first_not_of(std::string_view(" \n\r\t\0", 5)) == std::string::npos) return "there is no build log";
    const std::size_t at = log.find("error:");
    if (at == std::string::npos) return "see the build log";
    const std::size_t begin = log.rfind('\n', at) == std::string::npos ? 0 : log.rfind('\n', at) + 1;
    return log.substr(begin, log.find('\n', at) - begin);
}

// pocl 6 that is asked for a binary compiles every kernel anew, for groups of any size. From LLVM 18 on a check within
// that ends the process over some kernels (pocl issue 1608); which ones, nothing tells beforehand.
bool asking_may_abort(cl_device_id device) {
    constexpr const char* doing = "asking for the version of the platform";
    const auto platform = info<cl_platform_id>(clGetDeviceInfo, device, CL_DEVICE_PLATFORM, doing);
    const std::string version = info_text(clGetPlatformInfo, platform, CL_PLATFORM_VERSION, doing);
    const std::size_t at = version.find(" LLVM ");
    int llvm = 0;
    return version.find(" PoCL 6.") != std::string::npos && at != std::string::npos &&
           std::sscanf(version.c_str() + at, " LLVM %d", &llvm) == 1 && llvm >= 18;
}

}  // namespace

std::string program_source(std::span<const std::string_view> files) {
    std::string source;
    std::set<std::string_view> included;
    for (const std::string_view file : files) append(source, file, included);
    return source;
}

ProgramHandle build_program(cl_context context, cl_device_id device, const std::string& source,
                            const std::string& build_options) {
    cl_int status = CL_SUCCESS;
    const char* text = source.data();
    const std::size_t length = source.size();
    ProgramHandle program(clCreateProgramWithSource(context, 1, &text, &length, &status));
    check(status, "creating the kernel program");
    status = clBuildProgram(program.get(), 1, &device, build_options.c_str(), nullptr, nullptr);
    if (status != CL_SUCCESS) {
        std::size_t size = 0;
        clGetProgramBuildInfo(program.get(), device, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size);
        std::string log(size, '\0');
        clGetProgramBuildInfo(program.get(), device, CL_PROGRAM_BUILD_LOG, size, log.data(), nullptr);
        throw Error(ErrorCode::kernel_build,
                    "building the kernels with \"" + build_options + "\" failed with " + opencl_status_name(status) +
                        ": " + first_error(log),
                    status, log);
    }
    return program;
}

ProgramHandle load_program(cl_context context, cl_device_id device, std::span<const std::byte> driver_binary,
                           const std::string& build_options) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(driver_binary.data());
    const std::size_t size = driver_binary.size();
    cl_int status = CL_SUCCESS, binary_status = CL_SUCCESS;
    ProgramHandle program(clCreateProgramWithBinary(context, 1, &device, &size, &bytes, &binary_status, &status));
    if (status != CL_SUCCESS || binary_status != CL_SUCCESS ||
        clBuildProgram(program.get(), 1, &device, build_options.c_str(), nullptr, nullptr) != CL_SUCCESS)
        return {};
    return program;
}

std::vector<std::byte> driver_binary(cl_program program, cl_device_id device) {
    if (asking_may_abort(device)) return {};
    // The program belongs to all devices of the context, built for this one alone.
    constexpr const char* doing = "asking the kernel program for its binary";
    cl_uint count = 0;
    check(clGetProgramInfo(program, CL_PROGRAM_NUM_DEVICES, sizeof count, &count, nullptr), doing);
    std::vector<cl_device_id> devices(count);
    check(clGetProgramInfo(program, CL_PROGRAM_DEVICES, count * sizeof(cl_device_id), devices.data(), nullptr), doing);
    std::vector<std::size_t> sizes(count);
    check(clGetProgramInfo(program, CL_PROGRAM_BINARY_SIZES, count * sizeof(std::size_t), sizes.data(), nullptr),
          doing);
    // pocl 3.1 puts the one binary first, whichever device it is of.
    std::size_t at = static_cast<std::size_t>(std::ranges::find(devices, device) - devices.begin());
    if (at == count || sizes[at] == 0)
        at = static_cast<std::size_t>(std::ranges::find_if(sizes, std::identity{}) - sizes.begin());
    if (at == count) return {};
    // A place for each: pocl 3.1 writes through the null that by the specification leaves one out.
    std::vector<std::vector<std::byte>> binaries;
    std::vector<void*> places;
    for (const std::size_t size : sizes) places.push_back(binaries.emplace_back(size).data());
    check(clGetProgramInfo(program, CL_PROGRAM_BINARIES, count * sizeof(void*), places.data(), nullptr), doing);
    return binaries[at];
}

}  // namespace apsl::host
