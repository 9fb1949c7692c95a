// SPDX-License-Identifier: MIT
#include <apsl/strain_limiter.hpp>

#include "limiter_implementation.hpp"
#include "opencl_error.hpp"

namespace apsl {

StrainLimiter::StrainLimiter(cl_context context, cl_device_id device,
                             std::span<const std::shared_ptr<const Topology>> cloths, const Options& options,
                             std::span<const std::byte> program_binary)
    : implementation_(std::make_unique<Implementation>(context, device, cloths, options, program_binary)) {
}

StrainLimiter::StrainLimiter(cl_context context, cl_device_id device, const std::shared_ptr<const Topology>& cloth,
                             const Options& options, std::span<const std::byte> program_binary)
    : StrainLimiter(context, device, std::span(&cloth, 1), options, program_binary) {
}

StrainLimiter::~StrainLimiter() = default;
StrainLimiter::StrainLimiter(StrainLimiter&&) noexcept = default;
StrainLimiter& StrainLimiter::operator=(StrainLimiter&&) noexcept = default;

std::size_t StrainLimiter::scratch_bytes() const noexcept {
    return implementation_->bytes;
}

std::size_t StrainLimiter::cloth_count() const noexcept {
    return implementation_->cloth_count;
}

const Options& StrainLimiter::options() const noexcept {
    return implementation_->options;
}

std::vector<std::byte> StrainLimiter::program_binary() const {
    return implementation_->program_binary();
}

ProgramBinaryUse StrainLimiter::program_binary_use() const noexcept {
    return implementation_->binary_use;
}

cl_event StrainLimiter::enqueue(cl_command_queue queue, const Buffers& buffers, std::span<const Parameters> parameters,
                                std::span<const cl_event> wait_list) {
    return implementation_->enqueue(queue, buffers, parameters, wait_list);
}

cl_event StrainLimiter::enqueue(cl_command_queue queue, const Buffers& buffers, const Parameters& parameters,
                                std::span<const cl_event> wait_list) {
    return implementation_->enqueue(queue, buffers, std::span(&parameters, 1), wait_list);
}

cl_event StrainLimiter::read_stats(cl_command_queue queue, std::span<Stats> stats,
                                   std::span<const cl_event> wait_list) const {
    if (stats.size() != implementation_->cloth_count)
        throw Error(ErrorCode::invalid_argument, std::to_string(stats.size()) +
                                                     " statistics asked for, expected one for each of " +
                                                     std::to_string(implementation_->cloth_count) + " cloths");
    cl_event event = nullptr;
    host::check(clEnqueueReadBuffer(queue, implementation_->stats.get(), CL_FALSE, 0, stats.size_bytes(), stats.data(),
                                    static_cast<cl_uint>(wait_list.size()),
                                    wait_list.empty() ? nullptr : wait_list.data(), &event),
                "queueing the read of the statistics");
    return event;
}

void StrainLimiter::set_profiling(bool on) noexcept {
    implementation_->profiling = on;
}

std::vector<KernelTime> StrainLimiter::profile() {
    return implementation_->profile.collect();
}

}  // namespace apsl
