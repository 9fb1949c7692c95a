// SPDX-License-Identifier: MIT
#pragma once

#include "handles.hpp"

#include <apsl/strain_limiter.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace apsl::host {

/// A kernel and its name, for messages and profiles.
struct Kernel {
    std::string name;
    KernelHandle handle;
};

/// Throws Error(opencl) naming the kernel.
Kernel create_kernel(cl_program program, const char* name);

void set_argument(const Kernel& kernel, cl_uint index, const void* value, std::size_t size);

template <class Value>
void set_argument(const Kernel& kernel, cl_uint index, const Value& value) {
    if constexpr (requires { value.get(); }) {
        const auto object = value.get();
        set_argument(kernel, index, &object, sizeof object);
    } else {
        set_argument(kernel, index, &value, sizeof value);
    }
}

/// Sets the arguments from `first` on, in order. Buffers as handles, numbers as themselves.
template <class... Values>
void set_arguments(const Kernel& kernel, cl_uint first, const Values&... values) {
    (set_argument(kernel, first++, values), ...);
}

/// Launches whose events are kept until somebody asks for their times.
class LaunchProfile {
public:
    void keep(const std::string& name, EventHandle event) { launches_.push_back({name, std::move(event)}); }
    /// Waits for the launches, adds up their device times by kernel in order of first launch, and forgets them.
    std::vector<KernelTime> collect();

private:
    struct Launch {
        std::string name;
        EventHandle event;
    };
    std::vector<Launch> launches_;
};

/// The commands of one call, each after the one before, on either kind of queue: an in-order queue does that itself, on
/// an out-of-order queue each command waits for its predecessor's event. Never waits on the host.
class CommandSequence {
public:
    /// `profile` may be null.
    CommandSequence(cl_command_queue queue, std::span<const cl_event> wait_list, LaunchProfile* profile);

    void fill(const BufferHandle& buffer, const void* pattern, std::size_t pattern_size, std::size_t offset,
              std::size_t size);
    /// `groups` work-groups of `group_size` for each of `cloths`.
    void launch(const Kernel& kernel, std::uint32_t groups, std::uint32_t group_size, std::uint32_t cloths);
    /// Completes with the last command given. The caller owns it. To be called once, at the end.
    cl_event end();

private:
    template <class Enqueue>
    void command(const Enqueue& enqueue, const char* doing, const std::string* profiled_name);

    cl_command_queue queue_;
    std::span<const cl_event> wait_list_;
    LaunchProfile* profile_;
    bool out_of_order_ = false;
    EventHandle previous_;
};

}  // namespace apsl::host
