// SPDX-License-Identifier: MIT
#pragma once

#include <CL/cl.h>

#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace apsl::test {

/// The device all OpenCL tests run on, and one context with it.
///
/// APSL_TEST_PLATFORM: a part of the platform's name; the first platform with a device where it is not set.
/// APSL_TEST_DEVICE: the number of the device on that platform, from 0.
struct Device {
    cl_device_id id = nullptr;
    cl_context context = nullptr;
    std::string platform_name;
    std::string name;
};

/// Throws std::runtime_error where there is no such device: a machine without one fails these tests, it does not skip
/// them.
const Device& device();

/// Shared ownership of an OpenCL object; release is what clRelease… it needs.
template <class Object>
using Owned = std::shared_ptr<std::remove_pointer_t<Object>>;

/// Throws std::runtime_error naming the call and the status unless it is CL_SUCCESS.
void require_success(cl_int status, const char* call);

Owned<cl_command_queue> in_order_queue();
/// Null where the device has none.
Owned<cl_command_queue> out_of_order_queue();

/// Waits for the event, releases it and returns its execution status: CL_COMPLETE, or a negative error.
cl_int wait_and_release(cl_event event);

/// Device memory between two guard bands. Reading it back checks that nothing was written outside.
class GuardedMemory {
public:
    GuardedMemory(const void* contents, std::size_t bytes);
    /// What kernels are given: the part between the bands.
    cl_mem get() const { return payload_.get(); }
    std::size_t bytes() const { return bytes_; }
    /// Throws std::runtime_error saying which band was written to, and where.
    void read(void* contents) const;
    void write(const void* contents);

private:
    std::size_t bytes_;
    std::size_t band_;
    Owned<cl_mem> whole_;
    Owned<cl_mem> payload_;
};

/// An array of values in guarded device memory.
template <class Value>
class DeviceArray {
public:
    explicit DeviceArray(std::span<const Value> contents)
        : count_(contents.size()), memory_(contents.data(), contents.size_bytes()) {}
    explicit DeviceArray(const std::vector<Value>& contents) : DeviceArray(std::span(contents)) {}
    cl_mem get() const { return memory_.get(); }
    std::size_t size() const { return count_; }
    /// The contents; the guard bands are checked on the way.
    std::vector<Value> read() const {
        std::vector<Value> contents(count_);
        memory_.read(contents.data());
        return contents;
    }
    void write(const std::vector<Value>& contents) { memory_.write(contents.data()); }

private:
    std::size_t count_;
    GuardedMemory memory_;
};

/// Values with every bit set: NaN for floats, −1 for integers. What outputs hold before a run.
template <class Value>
std::vector<Value> poison(std::size_t count) {
    std::vector<Value> values(count);
    if (count > 0) std::memset(static_cast<void*>(values.data()), 0xFF, count * sizeof(Value));
    return values;
}

/// Equality of every bit: NaN equals itself, −0 differs from 0.
template <class Value>
bool same_bytes(const std::vector<Value>& a, const std::vector<Value>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Value)) == 0);
}

}  // namespace apsl::test
