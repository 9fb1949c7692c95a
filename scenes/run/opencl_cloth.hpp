// SPDX-License-Identifier: MIT
#pragma once

#include "host/handles.hpp"
#include "pipeline/cloth_state.hpp"
#include "run/opencl_devices.hpp"
#include "run/scene.hpp"

#include <apsl/strain_limiter.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace apsl::scenes {

/// A cloth in a context, an in-order queue and buffers of the program's own, with a limiter for it: what an embedding
/// program has.
class OpenClCloth {
public:
    /// Compiles, allocates, uploads. Throws InputError (an OpenCL call failed) and Error.
    OpenClCloth(const OpenClDevice& device, const ClothState& cloth, const StrainLimiting& settings, bool profile);

    cl_context context() const { return context_.get(); }
    cl_command_queue queue() const { return queue_.get(); }
    cl_device_id device() const { return device_; }
    cl_mem positions() const { return positions_.get(); }    ///< m, floats around an origin of the caller's, [3V]
    cl_mem velocities() const { return velocities_.get(); }  ///< m/s, [3V]
    cl_mem inverse_masses() const { return inverse_masses_.get(); }

    /// Queues a call of the limiter. `contacts`: Buffers::contacts, with Options::keeps_contacts.
    void queue_call(cl_mem contacts = nullptr);
    /// Queues a kernel of the program's own, one work-item for each of `count`.
    void launch(cl_kernel kernel, const std::string& name, std::size_t count);
    /// Waits until all is done that was queued; what the last call did.
    const Stats& wait_for_stats();

    /// A buffer that holds `bytes`; counted among the device's. Throws InputError naming it.
    host::BufferHandle make_buffer(std::span<const std::byte> bytes, const std::string& name);

    const std::string& device_name() const { return device_name_; }
    /// The limiter's memory and the buffers made here.
    std::size_t device_bytes() const { return limiter_.scratch_bytes() + buffer_bytes_; }
    /// Device time by kernel, since the last call; only with `profile`.
    std::vector<KernelTime> kernel_times();

private:
    host::BufferHandle make_buffer(const std::vector<float>& values, const std::string& name);

    std::string device_name_;
    cl_device_id device_;
    Parameters parameters_;
    bool profile_;
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
    host::BufferHandle rest_hinges_;
    host::BufferHandle tether_anchors_;
    host::BufferHandle tether_lengths_;
    std::vector<std::pair<std::string, host::EventHandle>> launches_;  // only with profile_
    Stats stats_{};
};

/// Of positions, m: where to lay the origin. The limiter looks at differences alone, and 32 bits hold those of a cloth
/// far from the origin badly: of 1 km they resolve 0.06 mm. Nearby the origin stays, and so does every bit.
std::array<double, 3> origin_for(const std::vector<double>& positions);

std::vector<float> to_float(const std::vector<double>& values);
std::vector<float> to_float_around(const std::array<double, 3>& origin, const std::vector<double>& positions);

}  // namespace apsl::scenes
