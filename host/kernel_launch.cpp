// SPDX-License-Identifier: MIT
#include "kernel_launch.hpp"

#include "opencl_error.hpp"

#include <algorithm>

namespace apsl::host {

Kernel create_kernel(cl_program program, const char* name) {
    cl_int status = CL_SUCCESS;
    Kernel kernel{name, KernelHandle(clCreateKernel(program, name, &status)), {}};
    check(status, ("creating kernel " + kernel.name).c_str());
    cl_uint count = 0;
    check(clGetKernelInfo(kernel.handle.get(), CL_KERNEL_NUM_ARGS, sizeof count, &count, nullptr),
          ("asking for the arguments of kernel " + kernel.name).c_str());
    kernel.arguments.resize(count);
    return kernel;
}

void ArgumentList::set(const void* value, std::size_t size) {
    const cl_int status = clSetKernelArg(kernel_.handle.get(), next_, size, value);
    if (status != CL_SUCCESS)
        check(status, ("setting argument " + std::to_string(next_) + " of kernel " + kernel_.name).c_str());
    ++next_;
}

std::vector<KernelTime> LaunchProfile::collect() {
    std::vector<KernelTime> times;
    for (const Launch& launch : launches_) {
        const cl_event event = launch.event.get();
        check(clWaitForEvents(1, &event), "waiting for a profiled launch");
        cl_ulong begin = 0, end = 0;
        check(clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof begin, &begin, nullptr),
              "reading a launch's time (the queue needs CL_QUEUE_PROFILING_ENABLE)");
        check(clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof end, &end, nullptr),
              "reading a launch's time");
        auto time = std::find_if(times.begin(), times.end(), [&](const auto& t) { return t.name == launch.name; });
        if (time == times.end()) time = times.insert(times.end(), KernelTime{launch.name, 0, 0.0});
        time->launches += 1;
        time->seconds += 1e-9 * static_cast<double>(end - begin);
    }
    launches_.clear();
    return times;
}

CommandSequence::CommandSequence(cl_command_queue queue, std::span<const cl_event> wait_list, LaunchProfile* profile)
    : queue_(queue), wait_list_(wait_list), profile_(profile) {
    cl_command_queue_properties properties = 0;
    check(clGetCommandQueueInfo(queue, CL_QUEUE_PROPERTIES, sizeof properties, &properties, nullptr),
          "asking the queue for its properties");
    out_of_order_ = (properties & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE) != 0;
    if (!(properties & CL_QUEUE_PROFILING_ENABLE)) profile_ = nullptr;
}

template <class Enqueue>
void CommandSequence::command(const Enqueue& enqueue, const char* doing, const std::string* profiled_name) {
    const cl_event before = previous_.get();
    const cl_uint wait_count = before ? 1 : static_cast<cl_uint>(wait_list_.size());
    const cl_event* waits = before ? &before : wait_list_.empty() ? nullptr : wait_list_.data();
    cl_event event = nullptr;
    const bool profiled = profile_ && profiled_name;
    const cl_int status = enqueue(wait_count, waits, out_of_order_ || profiled ? &event : nullptr);
    if (status != CL_SUCCESS) check(status, doing);
    wait_list_ = {};
    if (profiled) {
        if (out_of_order_) clRetainEvent(event);
        profile_->keep(*profiled_name, EventHandle(event));
    }
    if (out_of_order_) previous_ = EventHandle(event);
}

void CommandSequence::fill(const BufferHandle& buffer, const void* pattern, std::size_t pattern_size,
                           std::size_t offset, std::size_t size) {
    command(
        [&](cl_uint wait_count, const cl_event* waits, cl_event* event) {
            return clEnqueueFillBuffer(queue_, buffer.get(), pattern, pattern_size, offset, size, wait_count, waits,
                                       event);
        },
        "queueing the parameters", nullptr);
}

void CommandSequence::launch(const Kernel& kernel, std::uint32_t groups, std::uint32_t group_size,
                             std::uint32_t cloths) {
    const std::array<std::size_t, 2> global{std::size_t{groups} * group_size, cloths};
    const std::array<std::size_t, 2> local{group_size, 1};
    command(
        [&](cl_uint wait_count, const cl_event* waits, cl_event* event) {
            return clEnqueueNDRangeKernel(queue_, kernel.handle.get(), 2, nullptr, global.data(), local.data(),
                                          wait_count, waits, event);
        },
        ("queueing kernel " + kernel.name).c_str(), &kernel.name);
}

cl_event CommandSequence::end() {
    if (previous_) return previous_.give_up();
    cl_event event = nullptr;
    // Where nothing was queued, the end is that of what there was to wait for.
    check(clEnqueueMarkerWithWaitList(queue_, static_cast<cl_uint>(wait_list_.size()),
                                      wait_list_.empty() ? nullptr : wait_list_.data(), &event),
          "queueing the end of the call");
    return event;
}

}  // namespace apsl::host
