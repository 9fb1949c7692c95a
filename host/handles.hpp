// SPDX-License-Identifier: MIT
#pragma once

#include <CL/cl.h>

#include <utility>

namespace apsl::host {

/// Owns one reference to an OpenCL object.
template <class Type, cl_int(CL_API_CALL* release)(Type)>
class Handle {
public:
    Handle() = default;
    explicit Handle(Type object) noexcept : object_(object) {}
    Handle(Handle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(object_, other.object_);
        return *this;
    }
    ~Handle() {
        if (object_) release(object_);
    }
    Type get() const noexcept { return object_; }
    Type give_up() noexcept { return std::exchange(object_, nullptr); }
    explicit operator bool() const noexcept { return object_ != nullptr; }

private:
    Type object_ = nullptr;
};

using ContextHandle = Handle<cl_context, clReleaseContext>;
using QueueHandle = Handle<cl_command_queue, clReleaseCommandQueue>;
using ProgramHandle = Handle<cl_program, clReleaseProgram>;
using KernelHandle = Handle<cl_kernel, clReleaseKernel>;
using BufferHandle = Handle<cl_mem, clReleaseMemObject>;
using EventHandle = Handle<cl_event, clReleaseEvent>;

}  // namespace apsl::host
