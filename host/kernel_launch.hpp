// SPDX-License-Identifier: MIT
#pragma once

#include "handles.hpp"

#include <apsl/strain_limiter.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace apsl::host {

/// A kernel, its name for messages and profiles, and what its arguments were last set to.
struct Kernel {
    /// The bytes of a buffer's handle or of a number.
    struct Argument {
        std::uint64_t value = 0;
        bool known = false;
    };

    std::string name;
    KernelHandle handle;
    mutable std::vector<Argument> arguments;
};

/// Throws Error(opencl) naming the kernel.
Kernel create_kernel(cl_program program, const char* name);

/// Arguments of a kernel, one after the other from its first on. One that has the value of the launch before is not set
/// again: a call launches some kernels a hundred times.
class ArgumentList {
public:
    explicit ArgumentList(const Kernel& kernel) : kernel_(kernel) {}

    /// A buffer by its handle, a number, or a struct.
    template <class Value>
    void add(const Value& value) {
        if constexpr (requires { value.get(); })
            add_value(value.get());
        else
            add_value(value);
    }
    /// The buffer and the place of its first float. What is the caller's is set again every time: a new buffer may have
    /// the handle of one that was released.
    void add(const BufferView& view) {
        set(&view.buffer, sizeof view.buffer);
        set_number(cl_ulong{view.offset / sizeof(float)});
    }
    /// Several, in order.
    template <class... Values>
    void add(const std::tuple<Values...>& values) {
        std::apply([this](const Values&... each) { (add(each), ...); }, values);
    }
    /// What only some builds of a kernel have an argument for: null in the others.
    template <class Value>
    void add(const Value* optional) {
        if (optional) add(*optional);
    }

private:
    template <class Value>
    void add_value(const Value& value) {
        if constexpr (sizeof(Value) <= sizeof(std::uint64_t))
            set_number(value);
        else
            set(&value, sizeof value);
    }
    template <class Number>
    void set_number(const Number& number) {
        std::uint64_t bytes = 0;
        std::memcpy(&bytes, &number, sizeof number);
        Kernel::Argument& last = kernel_.arguments[next_];
        if (last.known && last.value == bytes) {
            ++next_;
            return;
        }
        set(&number, sizeof number);
        last = {bytes, true};
    }
    void set(const void* value, std::size_t size);

    const Kernel& kernel_;
    cl_uint next_ = 0;
};

/// All arguments, in order: buffers as what owns them, the caller's as BufferView, numbers as themselves.
template <class... Values>
const Kernel& set_arguments(const Kernel& kernel, const Values&... values) {
    ArgumentList list(kernel);
    (list.add(values), ...);
    return kernel;
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
