// SPDX-License-Identifier: MIT
#pragma once

#include "handles.hpp"
#include "values.hpp"

#include <apsl/strain_limiter.hpp>

#include <mutex>
#include <optional>

namespace apsl::python {

/// A StrainLimiter with a context, a queue and buffers of its own, for arrays that live on the host. Calls from several
/// threads wait for one another; the interpreter's lock is released while kernels are compiled or run.
class Limiter {
public:
    /// triangles [T, 3]; device: None, a number of devices(), or an object with such a `number`. Throws Error,
    /// TypeError for an option that does not exist.
    Limiter(py::handle triangles, py::handle vertex_count, py::handle device, const py::kwargs& options);

    /// The limited velocities, float32 [V, 3], and a dictionary of the fields of Stats; with Options::integrates the
    /// positions at the end of the step, float32 [V, 3], before them. Throws likewise.
    py::tuple limit(py::handle positions, py::handle velocities, py::handle inverse_masses, py::handle rest_areas,
                    const py::kwargs& parameters);

    std::size_t scratch_bytes() const { return limiter_->scratch_bytes(); }
    py::dict options() const { return to_dict(limiter_->options(), option_fields); }

private:
    // Of numbers of 32 bits.
    host::BufferHandle make_buffer(std::size_t count);
    void upload(const host::BufferHandle& buffer, const void* numbers, std::size_t count);

    std::mutex mutex_;
    std::size_t vertex_count_;
    std::size_t triangle_count_ = 0;
    std::size_t hinge_count_ = 0;
    std::size_t tethers_per_vertex_ = 0;
    host::ContextHandle context_;
    host::QueueHandle queue_;
    std::optional<StrainLimiter> limiter_;
    host::BufferHandle positions_;
    host::BufferHandle velocities_;
    host::BufferHandle inverse_masses_;
    host::BufferHandle rest_areas_;
    host::BufferHandle regularization_;    // where Options::regularization_per_triangle
    host::BufferHandle rest_shapes_;       // where Options::limits_stretch
    host::BufferHandle rest_hinges_;       // where Options::bends
    host::BufferHandle accelerations_;     // where Options::acceleration_per_vertex
    host::BufferHandle stretch_ceilings_;  // where Options::stretch_ceiling_per_triangle
    host::BufferHandle contacts_;          // where Options::keeps_contacts
    host::BufferHandle tether_anchors_;    // where Options::tethers_per_vertex
    host::BufferHandle tether_lengths_;    // likewise
};

}  // namespace apsl::python
