// SPDX-License-Identifier: MIT
// Preloaded into a program: writes down every kernel launch with what its buffers hold before and after, and makes the
// OpenCL device claim to be a GPU, so that the library chooses what it chooses on one.
//
// APSL_RECORDING: the folder to write to. APSL_RECORDED_COMPUTE_UNITS: what the device claims to have, 1 if not set.
// index.txt holds a line for each program, launch and argument; recording.py reads it. Contents of buffers are files
// named by their hash, so that what does not change is written once.
#include <CL/cl.h>

#include <dlfcn.h>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace {

// What AMD's OpenCL lets a group have at most.
constexpr std::size_t largest_work_group = 256;

[[noreturn]] void give_up(const std::string& why) {
    std::cerr << "recorder: " << why << '\n';
    std::abort();
}

// The function that this library stands in front of.
template <class Function>
Function* next(Function*, const char* name) {
    auto* const found = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
    if (!found) give_up(std::string("no ") + name + " to call");
    return found;
}
#define APSL_NEXT(function) static auto* const real = next(&function, #function)

struct RecordedKernel {
    std::string name;
    std::size_t program;
    std::vector<std::string> arguments;
};

struct Recording {
    std::filesystem::path folder;
    std::ofstream index;
    std::map<cl_program, std::size_t> programs;
    std::map<cl_kernel, RecordedKernel> kernels;
    std::map<cl_mem, std::size_t> buffers;  // in the order they were made: an address may come back
    std::size_t made_programs = 0, made_buffers = 0, launches = 0;

    Recording() {
        const char* const wanted = std::getenv("APSL_RECORDING");
        if (!wanted) give_up("APSL_RECORDING is not set, expected a folder");
        folder = wanted;
        std::filesystem::create_directories(folder);
        index.open(folder / "index.txt");
        if (!index) give_up("cannot write " + (folder / "index.txt").string());
    }
};

// Released with the process: kernels may be launched while static objects are destroyed.
Recording& recording() {
    static auto* const made = new Recording;
    return *made;
}

std::recursive_mutex mutex;

std::string hex(const void* data, std::size_t size) {
    constexpr char digits[] = "0123456789abcdef";
    const auto* bytes = static_cast<const unsigned char*>(data);
    std::string text;
    for (std::size_t n = 0; n < size; ++n) {
        text += digits[bytes[n] >> 4];
        text += digits[bytes[n] & 15];
    }
    return text;
}

// Writes the contents unless they have been, and returns their file's name.
std::string stored(const std::vector<char>& contents) {
    std::uint64_t hash = 14695981039346656037u;  // FNV-1a
    for (const char c : contents) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
    const std::string name = "contents_" + hex(&hash, sizeof hash) + "_" + std::to_string(contents.size());
    const std::filesystem::path path = recording().folder / name;
    if (!std::filesystem::exists(path)) {
        std::ofstream file(path, std::ios::binary);
        file.write(contents.data(), static_cast<std::streamsize>(contents.size()));
        if (!file.flush()) give_up("cannot write " + path.string());
    }
    return name;
}

std::vector<char> contents_of(cl_command_queue queue, cl_mem buffer) {
    std::size_t size = 0;
    clGetMemObjectInfo(buffer, CL_MEM_SIZE, sizeof size, &size, nullptr);
    std::vector<char> contents(size);
    if (clEnqueueReadBuffer(queue, buffer, CL_TRUE, 0, size, contents.data(), 0, nullptr, nullptr) != CL_SUCCESS)
        give_up("a buffer cannot be read");
    return contents;
}

cl_mem buffer_of(const std::string& argument) {
    cl_mem buffer = nullptr;
    if (argument.size() != sizeof buffer) return nullptr;
    std::memcpy(&buffer, argument.data(), sizeof buffer);
    return recording().buffers.contains(buffer) ? buffer : nullptr;
}

cl_mem counted(cl_mem buffer) {
    const std::lock_guard lock(mutex);
    if (buffer) recording().buffers[buffer] = recording().made_buffers++;
    return buffer;
}

template <class Value>
void claim(void* place, Value value) {
    std::memcpy(place, &value, sizeof value);
}

// pocl 6 with LLVM 18 ends the process over rest_hinges where it is not optimised (pocl issue 1608).
bool aborts_unoptimised(cl_device_id device) {
    cl_platform_id platform = nullptr;
    char version[1024] = {};
    return clGetDeviceInfo(device, CL_DEVICE_PLATFORM, sizeof platform, &platform, nullptr) == CL_SUCCESS &&
           clGetPlatformInfo(platform, CL_PLATFORM_VERSION, sizeof version, version, nullptr) == CL_SUCCESS &&
           std::strstr(version, "PoCL 6.") && std::strstr(version, "LLVM 18.");
}

}  // namespace

#define APSL_RECORDED extern "C" __attribute__((visibility("default")))

APSL_RECORDED cl_int clGetDeviceInfo(cl_device_id device, cl_device_info what, size_t size, void* value,
                                     size_t* size_needed) {
    APSL_NEXT(clGetDeviceInfo);
    const cl_int status = real(device, what, size, value, size_needed);
    if (status != CL_SUCCESS || !value) return status;
    const char* const units = std::getenv("APSL_RECORDED_COMPUTE_UNITS");
    if (what == CL_DEVICE_TYPE) claim<cl_device_type>(value, CL_DEVICE_TYPE_GPU);
    if (what == CL_DEVICE_MAX_COMPUTE_UNITS)
        claim<cl_uint>(value, units ? static_cast<cl_uint>(std::strtoul(units, nullptr, 10)) : 1);
    if (what == CL_DEVICE_MAX_WORK_GROUP_SIZE) claim<std::size_t>(value, largest_work_group);
    return status;
}

APSL_RECORDED cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void* contents,
                                    cl_int* status) {
    APSL_NEXT(clCreateBuffer);
    return counted(real(context, flags, size, contents, status));
}

APSL_RECORDED cl_mem clCreateSubBuffer(cl_mem buffer, cl_mem_flags flags, cl_buffer_create_type type,
                                       const void* region, cl_int* status) {
    APSL_NEXT(clCreateSubBuffer);
    return counted(real(buffer, flags, type, region, status));
}

APSL_RECORDED cl_program clCreateProgramWithSource(cl_context context, cl_uint count, const char** texts,
                                                   const size_t* lengths, cl_int* status) {
    APSL_NEXT(clCreateProgramWithSource);
    const cl_program program = real(context, count, texts, lengths, status);
    const std::lock_guard lock(mutex);
    Recording& to = recording();
    const std::size_t number = to.made_programs++;
    to.programs[program] = number;
    std::ofstream file(to.folder / ("program_" + std::to_string(number) + ".cl"), std::ios::binary);
    for (cl_uint n = 0; n < count; ++n)
        file << (lengths && lengths[n] > 0 ? std::string(texts[n], lengths[n]) : std::string(texts[n]));
    return program;
}

APSL_RECORDED cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id* devices, const char* options,
                                    void(CL_CALLBACK* done)(cl_program, void*), void* given) {
    APSL_NEXT(clBuildProgram);
    {
        const std::lock_guard lock(mutex);
        Recording& to = recording();
        to.index << "program " << to.programs[program] << ' ' << (options ? options : "") << '\n';
    }
    // Half of pocl's compile time, and most of the recording's, is optimisation.
    std::string built_with = options ? options : "";
    if (count == 0 || !aborts_unoptimised(devices[0])) built_with += " -cl-opt-disable";
    return real(program, count, devices, built_with.c_str(), done, given);
}

APSL_RECORDED cl_kernel clCreateKernel(cl_program program, const char* name, cl_int* status) {
    APSL_NEXT(clCreateKernel);
    const cl_kernel kernel = real(program, name, status);
    const std::lock_guard lock(mutex);
    if (kernel) recording().kernels[kernel] = {name, recording().programs[program], {}};
    return kernel;
}

APSL_RECORDED cl_int clSetKernelArg(cl_kernel kernel, cl_uint index, size_t size, const void* value) {
    APSL_NEXT(clSetKernelArg);
    {
        const std::lock_guard lock(mutex);
        std::vector<std::string>& arguments = recording().kernels[kernel].arguments;
        if (arguments.size() <= index) arguments.resize(index + 1);
        arguments[index] = value ? std::string(static_cast<const char*>(value), size) : std::string(size, '\0');
    }
    return real(kernel, index, size, value);
}

APSL_RECORDED cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                                            const size_t* offset, const size_t* global, const size_t* local,
                                            cl_uint wait_count, const cl_event* waits, cl_event* done) {
    APSL_NEXT(clEnqueueNDRangeKernel);
    const std::lock_guard lock(mutex);
    if (dimensions != 2 || offset || !local || local[1] != 1)
        give_up("a launch that is not a row of groups for each cloth");
    if (wait_count > 0) clWaitForEvents(wait_count, waits);
    clFinish(queue);
    Recording& to = recording();
    const RecordedKernel& launched = to.kernels[kernel];
    std::vector<std::string> before;
    for (const std::string& argument : launched.arguments) {
        const cl_mem buffer = buffer_of(argument);
        before.push_back(buffer ? stored(contents_of(queue, buffer)) : "");
    }
    const cl_int status = real(queue, kernel, dimensions, offset, global, local, wait_count, waits, done);
    clFinish(queue);
    to.index << "launch " << to.launches++ << ' ' << launched.name << ' ' << launched.program << ' '
             << global[0] / local[0] << ' ' << global[1] << ' ' << local[0] << '\n';
    for (std::size_t n = 0; n < launched.arguments.size(); ++n)
        if (const cl_mem buffer = buffer_of(launched.arguments[n]))
            to.index << "buffer " << to.buffers[buffer] << ' ' << before[n] << ' ' << stored(contents_of(queue, buffer))
                     << '\n';
        else
            to.index << "value " << hex(launched.arguments[n].data(), launched.arguments[n].size()) << '\n';
    to.index.flush();
    return status;
}
