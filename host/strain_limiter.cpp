// SPDX-License-Identifier: MIT
#include <apsl/strain_limiter.hpp>

#include "caller_objects.hpp"
#include "limiter_implementation.hpp"
#include "opencl_error.hpp"

namespace apsl {

StrainLimiter::StrainLimiter(cl_context context, cl_device_id device,
                             std::span<const std::shared_ptr<const Topology>> cloths, const Options& options,
                             std::span<const std::byte> program_binary, const BufferView& scratch) {
    host::check_device(context, device);
    implementation_ = std::make_unique<Implementation>(context, device, cloths, options, program_binary, scratch);
}

StrainLimiter::StrainLimiter(cl_context context, cl_device_id device, const std::shared_ptr<const Topology>& cloth,
                             const Options& options, std::span<const std::byte> program_binary,
                             const BufferView& scratch)
    : StrainLimiter(context, device, std::span(&cloth, 1), options, program_binary, scratch) {
}

StrainLimiter::~StrainLimiter() = default;
StrainLimiter::StrainLimiter(StrainLimiter&&) noexcept = default;
StrainLimiter& StrainLimiter::operator=(StrainLimiter&&) noexcept = default;

std::size_t StrainLimiter::required_scratch_bytes(cl_device_id device,
                                                  std::span<const std::shared_ptr<const Topology>> cloths,
                                                  const Options& options) {
    return Implementation::required_scratch_bytes(device, cloths, options);
}

void StrainLimiter::rebuild(std::span<const std::shared_ptr<const Topology>> cloths, const BufferView& scratch) {
    const Implementation& built = *implementation_;
    auto rebuilt = std::make_unique<Implementation>(built.context, built.device, cloths, built.options,
                                                    std::span<const std::byte>{}, scratch, &built);
    rebuilt->profiling = built.profiling;
    rebuilt->profile = std::move(implementation_->profile);
    implementation_ = std::move(rebuilt);
}

void StrainLimiter::rebuild(const std::shared_ptr<const Topology>& cloth, const BufferView& scratch) {
    rebuild(std::span(&cloth, 1), scratch);
}

std::size_t StrainLimiter::scratch_bytes() const noexcept {
    return implementation_->memory.bytes();
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

cl_event StrainLimiter::enqueue_rest_areas(cl_command_queue queue, const BufferView& rest_positions,
                                           const BufferView& rest_areas, std::span<const cl_event> wait_list) {
    return implementation_->enqueue_rest_areas(queue, rest_positions, rest_areas, wait_list);
}

cl_event StrainLimiter::enqueue_rest_shapes(cl_command_queue queue, const BufferView& rest_positions,
                                            const BufferView& rest_shapes, std::span<const cl_event> wait_list) {
    return implementation_->enqueue_rest_shapes(queue, rest_positions, rest_shapes, wait_list);
}

cl_event StrainLimiter::enqueue_rest_hinges(cl_command_queue queue, const BufferView& rest_positions,
                                            const BufferView& rest_hinges, std::span<const cl_event> wait_list) {
    return implementation_->enqueue_rest_hinges(queue, rest_positions, rest_hinges, wait_list);
}

cl_event StrainLimiter::read_stats(cl_command_queue queue, std::span<Stats> stats,
                                   std::span<const cl_event> wait_list) const {
    if (stats.size() != implementation_->cloth_count)
        throw Error(ErrorCode::invalid_argument, std::to_string(stats.size()) +
                                                     " statistics asked for, expected one for each of " +
                                                     std::to_string(implementation_->cloth_count) + " cloths");
    host::check_queue(queue, wait_list, implementation_->context, implementation_->device);
    cl_event event = nullptr;
    host::check(clEnqueueReadBuffer(queue, implementation_->arrays.stats.get(), CL_FALSE, 0, stats.size_bytes(),
                                    stats.data(), static_cast<cl_uint>(wait_list.size()),
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
