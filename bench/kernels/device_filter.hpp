// SPDX-License-Identifier: MIT
#pragma once

#include "cloth.hpp"
#include "device.hpp"

#include <apsl/strain_limiter.hpp>

#include <vector>

namespace apsl::bench {

/// A StrainLimiter over one or more copies of a cloth, with its buffers on the device. Velocities start from zero in
/// every call, so that every call does the same work.
class DeviceFilter {
public:
    DeviceFilter(const Device& device, const Cloth& cloth, Apply apply, std::size_t copies = 1);

    /// One call, s from before enqueue until its event completes.
    double wall_seconds(const Parameters& parameters);
    /// One call with profiling events.
    std::vector<KernelTime> kernel_times(const Parameters& parameters);
    /// What the last call left behind: m/s, [3V] of all copies.
    std::vector<float> velocities() const;
    /// Of the last call, the worst of the copies.
    float max_area_change() const;

private:
    double run(cl_command_queue queue, const Parameters& parameters);

    const Device& device_;
    std::size_t velocity_bytes_;
    host::BufferHandle positions_, velocities_, inverse_masses_, rest_areas_;
    StrainLimiter limiter_;
};

}  // namespace apsl::bench
