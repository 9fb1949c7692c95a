// SPDX-License-Identifier: MIT
#pragma once

#include "host/handles.hpp"
#include "pipeline/cloth_state.hpp"
#include "run/check_opencl.hpp"
#include "run/opencl_devices.hpp"
#include "run/scene.hpp"

#include <apsl/strain_limiter.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace apsl::scenes {

/// apsl::StrainLimiter in a context, queue and buffers of the program's own: what an embedding program does, with the
/// rest of its pipeline on the host.
class OpenClFilter {
public:
    /// Compiles, allocates, uploads what stays the same. Throws InputError (an OpenCL call failed) and Error.
    OpenClFilter(const OpenClDevice& device, const ClothState& cloth, const StrainLimiting& settings, bool profile);

    /// Filters the cloth's velocities and waits for the result.
    Stats filter(ClothState& cloth);

    const std::string& device_name() const { return device_name_; }
    /// The limiter's memory and the buffers here.
    std::size_t device_bytes() const;
    /// Device time by kernel, since the last call; only with `profile`.
    std::vector<KernelTime> kernel_times() { return limiter_.profile(); }

private:
    host::BufferHandle make_buffer(const std::vector<float>& values, const std::string& name);

    std::string device_name_;
    Parameters parameters_;
    host::ContextHandle context_;
    host::QueueHandle queue_;
    StrainLimiter limiter_;
    std::size_t buffer_bytes_ = 0;
    host::BufferHandle positions_;
    host::BufferHandle velocities_;
    host::BufferHandle inverse_masses_;
    host::BufferHandle rest_areas_;
    host::BufferHandle regularization_;
    host::BufferHandle rest_shapes_;
    host::BufferHandle stretch_ceilings_;
    std::vector<float> uploaded_positions_;   // [3V]
    std::vector<float> uploaded_velocities_;  // [3V]
    std::vector<float> filtered_velocities_;  // [3V]
    Stats stats_{};
};

}  // namespace apsl::scenes
