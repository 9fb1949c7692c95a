// SPDX-License-Identifier: MIT
#include "device_memory.hpp"

#include "caller_objects.hpp"
#include "opencl_info.hpp"

#include <apsl/error.hpp>

namespace apsl::host {
namespace {

std::size_t round_up(std::size_t size, std::size_t alignment) {
    return (size + alignment - 1) / alignment * alignment;
}

std::size_t sub_buffer_alignment(cl_device_id device) {
    return info<cl_uint>(clGetDeviceInfo, device, CL_DEVICE_MEM_BASE_ADDR_ALIGN,
                         "asking the device for its alignment") /
           8;
}

}  // namespace

DeviceMemory::DeviceMemory(cl_context context, cl_device_id device, const DeviceFacts& facts, const BufferView& scratch)
    : context_(context), device_(device), facts_(facts), scratch_(scratch), alignment_(sub_buffer_alignment(device)) {
    if (scratch_.buffer) check_scratch(scratch_, context_);
}

BufferHandle DeviceMemory::allocate(std::size_t size, const void* contents) {
    if (size > facts_.max_allocation)
        throw Error(ErrorCode::unsupported, "a buffer of " + std::to_string(size) + " bytes is needed, device " +
                                                facts_.name + " allows " + std::to_string(facts_.max_allocation));
    BufferHandle handle;
    if (scratch_.buffer) {
        handle = cut(size, contents);
    } else if (context_) {
        cl_int status = CL_SUCCESS;
        handle = BufferHandle(clCreateBuffer(context_, CL_MEM_READ_WRITE | (contents ? CL_MEM_COPY_HOST_PTR : 0), size,
                                             const_cast<void*>(contents), &status));
        check(status, "allocating device memory");
    }
    bytes_ += size;
    aligned_ += round_up(size, alignment_);
    return handle;
}

std::size_t DeviceMemory::next_origin() const {
    return round_up(scratch_.offset, alignment_) + aligned_;
}

std::optional<FloatsInUse> DeviceMemory::scratch_in_use() const {
    if (!scratch_.buffer) return std::nullopt;
    const BufferView begin{scratch_.buffer, round_up(scratch_.offset, alignment_)};
    return FloatsInUse{"the limiter's scratch memory", begin, true, aligned_ / sizeof(float)};
}

void DeviceMemory::keep_clear_of(const DeviceMemory& other) {
    if (other.scratch_.buffer != scratch_.buffer) return;
    taken_begin_ = round_up(other.scratch_.offset, alignment_);
    taken_end_ = other.next_origin();
}

BufferHandle DeviceMemory::cut(std::size_t size, const void* contents) {
    std::size_t there = 0;
    check(clGetMemObjectInfo(scratch_.buffer, CL_MEM_SIZE, sizeof there, &there, nullptr),
          "asking the scratch memory for its size");
    const cl_buffer_region region{next_origin(), size};
    if (scratch_.offset > there || region.origin > there || there - region.origin < size)
        throw Error(ErrorCode::invalid_argument, "scratch holds " + std::to_string(there) + " bytes with offset " +
                                                     std::to_string(scratch_.offset) +
                                                     ", expected required_scratch_bytes() from there on");
    if (region.origin < taken_end_ && region.origin + size > taken_begin_)
        throw Error(ErrorCode::invalid_argument, "scratch with offset " + std::to_string(scratch_.offset) +
                                                     " overlaps the limiter's present memory, bytes " +
                                                     std::to_string(taken_begin_) + " to " +
                                                     std::to_string(taken_end_) + " of the same buffer");
    cl_int status = CL_SUCCESS;
    BufferHandle handle(
        clCreateSubBuffer(scratch_.buffer, CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region, &status));
    check(status, "cutting the scratch memory");
    if (contents) upload(handle, size, contents);
    return handle;
}

void DeviceMemory::upload(const BufferHandle& handle, std::size_t size, const void* contents) {
    if (!uploads_) {
        cl_int status = CL_SUCCESS;
        uploads_ = QueueHandle(clCreateCommandQueue(context_, device_, 0, &status));
        check(status, "creating a queue for the uploads");
    }
    check(clEnqueueWriteBuffer(uploads_.get(), handle.get(), CL_TRUE, 0, size, contents, 0, nullptr, nullptr),
          "uploading to the scratch memory");
}

// A blocking write has taken its contents when it returns. That other queues see them is not said before the queue has
// finished, and Intel's OpenCL copies up to 256 bytes later.
void DeviceMemory::finish_uploads() {
    if (!uploads_) return;
    check(clFinish(uploads_.get()), "uploading to the scratch memory");
    uploads_ = {};
}

// Where an error came between: the memory is the caller's again, and nothing may be written there any more.
DeviceMemory::~DeviceMemory() {
    if (uploads_) clFinish(uploads_.get());
}

}  // namespace apsl::host
