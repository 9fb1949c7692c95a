// SPDX-License-Identifier: MIT
#pragma once

#include "device_facts.hpp"
#include "handles.hpp"
#include "overlaps.hpp"

#include <apsl/strain_limiter.hpp>

#include <cstddef>
#include <optional>

namespace apsl::host {

/// Where a limiter's buffers come from: allocated one by one, cut from a place of the caller's, or only counted.
class DeviceMemory {
public:
    /// `scratch` with a null buffer: allocated. `context` null: only counted, as if cut from a place of the caller's.
    DeviceMemory(cl_context context, cl_device_id device, const DeviceFacts& facts, const BufferView& scratch);
    DeviceMemory(const DeviceMemory&) = delete;
    DeviceMemory& operator=(const DeviceMemory&) = delete;
    ~DeviceMemory();

    /// From here on allocate() throws Error(invalid_argument) where it would touch a place of `other`'s.
    void keep_clear_of(const DeviceMemory& other);
    /// `contents` may be null, and is copied before this returns. Throws Error: unsupported where the device has no
    /// buffer of that size, invalid_argument where the caller's place is too small, opencl.
    BufferHandle allocate(std::size_t size, const void* contents);
    /// After the last allocation: from then on every queue sees the contents. Waits.
    void finish_uploads();
    /// What all buffers so far take of the caller's place, which every call may write; none where they are allocated.
    std::optional<FloatsInUse> scratch_in_use() const;
    /// Of all buffers so far, without gaps.
    std::size_t bytes() const { return bytes_; }
    /// Likewise, cut from a place at any offset.
    std::size_t required() const { return aligned_ + alignment_; }

private:
    /// Where the buffer of `size` bytes that comes next begins in scratch_.
    std::size_t next_origin() const;
    BufferHandle cut(std::size_t size, const void* contents);
    void upload(const BufferHandle& handle, std::size_t size, const void* contents);

    cl_context context_;
    cl_device_id device_;
    DeviceFacts facts_;
    BufferView scratch_;
    std::size_t taken_begin_ = 0, taken_end_ = 0;  // bytes of scratch_'s buffer that are another's
    QueueHandle uploads_;                          // into scratch_, made with the first of them
    std::size_t alignment_;                        // of a sub-buffer, bytes
    std::size_t aligned_ = 0;                      // bytes of all buffers, each rounded up
    std::size_t bytes_ = 0;
};

}  // namespace apsl::host
