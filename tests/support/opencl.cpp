// SPDX-License-Identifier: MIT
#include "support/opencl.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

namespace apsl::test {
namespace {

constexpr unsigned char band_byte = 0xA5;

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

std::string platform_name(cl_platform_id platform) {
    std::size_t size = 0;
    require_success(clGetPlatformInfo(platform, CL_PLATFORM_NAME, 0, nullptr, &size), "clGetPlatformInfo");
    std::string name(size, '\0');
    require_success(clGetPlatformInfo(platform, CL_PLATFORM_NAME, size, name.data(), nullptr), "clGetPlatformInfo");
    return name.c_str();
}

std::string device_name(cl_device_id device) {
    std::size_t size = 0;
    require_success(clGetDeviceInfo(device, CL_DEVICE_NAME, 0, nullptr, &size), "clGetDeviceInfo");
    std::string name(size, '\0');
    require_success(clGetDeviceInfo(device, CL_DEVICE_NAME, size, name.data(), nullptr), "clGetDeviceInfo");
    return name.c_str();
}

Device choose_device() {
    const std::string wanted_platform = environment("APSL_TEST_PLATFORM");
    const std::string wanted_device = environment("APSL_TEST_DEVICE");
    const std::size_t number = wanted_device.empty() ? 0 : std::stoul(wanted_device);

    cl_uint count = 0;
    clGetPlatformIDs(0, nullptr, &count);  // fails where there is none
    std::vector<cl_platform_id> platforms(count);
    if (count > 0) require_success(clGetPlatformIDs(count, platforms.data(), nullptr), "clGetPlatformIDs");
    std::string seen;
    for (const cl_platform_id platform : platforms) {
        const std::string name = platform_name(platform);
        seen += seen.empty() ? name : ", " + name;
        if (name.find(wanted_platform) == std::string::npos) continue;
        cl_uint devices = 0;
        if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &devices) != CL_SUCCESS) continue;
        if (number >= devices) continue;
        std::vector<cl_device_id> ids(devices);
        require_success(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, devices, ids.data(), nullptr), "clGetDeviceIDs");
        cl_int status = CL_SUCCESS;
        const cl_context context = clCreateContext(nullptr, 1, &ids[number], nullptr, nullptr, &status);
        require_success(status, "clCreateContext");
        return {ids[number], context, name, device_name(ids[number])};
    }
    throw std::runtime_error(
        "no OpenCL device " + std::to_string(number) + " on a platform named \"" + wanted_platform +
        "\" (APSL_TEST_DEVICE, APSL_TEST_PLATFORM); platforms here: " + (seen.empty() ? "none" : seen));
}

Owned<cl_command_queue> queue(cl_command_queue_properties properties, cl_int& status) {
    const cl_command_queue made = clCreateCommandQueue(device().context, device().id, properties, &status);
    return status == CL_SUCCESS ? Owned<cl_command_queue>(made, clReleaseCommandQueue) : nullptr;
}

// Like the context never released: when static objects are destroyed, a driver may have let go of what it needs to
// release them with (Oclgrind then writes to memory it has freed).
cl_command_queue transfer_queue() {
    static const auto* const queue = new Owned<cl_command_queue>(in_order_queue());
    return queue->get();
}

}  // namespace

const Device& device() {
    static const Device chosen = choose_device();
    return chosen;
}

void require_success(cl_int status, const char* call) {
    if (status != CL_SUCCESS) throw std::runtime_error(std::string(call) + " failed with " + std::to_string(status));
}

Owned<cl_command_queue> in_order_queue() {
    cl_int status = CL_SUCCESS;
    Owned<cl_command_queue> made = queue(0, status);
    require_success(status, "clCreateCommandQueue");
    return made;
}

Owned<cl_command_queue> out_of_order_queue() {
    cl_int status = CL_SUCCESS;
    return queue(CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE, status);
}

cl_int wait_and_release(cl_event event) {
    cl_int outcome = clWaitForEvents(1, &event);
    if (outcome == CL_SUCCESS)
        require_success(clGetEventInfo(event, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof outcome, &outcome, nullptr),
                        "clGetEventInfo");
    require_success(clReleaseEvent(event), "clReleaseEvent");
    return outcome;
}

GuardedMemory::GuardedMemory(const void* contents, std::size_t bytes) : bytes_(bytes) {
    cl_uint alignment_bits = 0;
    require_success(
        clGetDeviceInfo(device().id, CL_DEVICE_MEM_BASE_ADDR_ALIGN, sizeof alignment_bits, &alignment_bits, nullptr),
        "clGetDeviceInfo");
    // A sub-buffer begins at a multiple of the alignment. No kernel strays further than a group's share of float8.
    band_ = std::max<std::size_t>(alignment_bits / 8, 4096);
    std::vector<unsigned char> bytes_of_all(bytes_ + 2 * band_, band_byte);
    std::memcpy(bytes_of_all.data() + band_, contents, bytes_);
    cl_int status = CL_SUCCESS;
    whole_ = Owned<cl_mem>(clCreateBuffer(device().context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR,
                                          bytes_of_all.size(), bytes_of_all.data(), &status),
                           clReleaseMemObject);
    require_success(status, "clCreateBuffer");
    const cl_buffer_region region{band_, bytes_};
    payload_ = Owned<cl_mem>(
        clCreateSubBuffer(whole_.get(), CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region, &status),
        clReleaseMemObject);
    require_success(status, "clCreateSubBuffer");
}

void GuardedMemory::read(void* contents) const {
    std::vector<unsigned char> all(bytes_ + 2 * band_);
    require_success(
        clEnqueueReadBuffer(transfer_queue(), whole_.get(), CL_TRUE, 0, all.size(), all.data(), 0, nullptr, nullptr),
        "clEnqueueReadBuffer");
    for (std::size_t n = 0; n < all.size(); ++n) {
        const bool in_band = n < band_ || n >= band_ + bytes_;
        if (in_band && all[n] != band_byte)
            throw std::runtime_error(n < band_ ? "written " + std::to_string(band_ - n) + " bytes before the array"
                                               : "written " + std::to_string(n - band_ - bytes_) +
                                                     " bytes past the end of the array");
    }
    std::memcpy(contents, all.data() + band_, bytes_);
}

// Makes the memory anew: get() is another buffer afterwards. A blocking write would not do. It may return with the copy
// still queued, and kernels run on other queues.
void GuardedMemory::write(const void* contents) {
    *this = GuardedMemory(contents, bytes_);
}

}  // namespace apsl::test
