// SPDX-License-Identifier: MIT
#pragma once

#include "handles.hpp"
#include "values.hpp"

#include <apsl/strain_limiter.hpp>

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace apsl::python {

/// A StrainLimiter in a context of the caller's, for arrays that live on the device. OpenCL objects come and go as the
/// addresses of their handles. Calls from several threads wait for one another; the interpreter's lock is released
/// while kernels are compiled, commands queued or waited for.
class DeviceLimiter {
public:
    using Address = std::uintptr_t;             ///< of an OpenCL object
    using Place = std::pair<Address, Address>;  ///< a buffer and an offset in bytes

    /// triangles [T, 3]; device: None where the context has one alone, a number of devices(), or an object with such a
    /// `number` or a handle as its `int_ptr`. The context is kept. Throws Error, TypeError for an option that does not
    /// exist.
    DeviceLimiter(py::handle triangles, py::handle vertex_count, Address context, py::handle device,
                  const py::kwargs& options);

    /// Queues a call and returns its event, which the caller releases. `places` by the names of limit()'s arguments.
    /// Throws likewise.
    Address enqueue(Address queue, const std::map<std::string, Place>& places, const std::vector<Address>& wait_for,
                    const py::kwargs& parameters);

    /// Waits for the statistics of the last call, a dictionary of the fields of Stats. Throws likewise.
    py::dict read_stats(Address queue, const std::vector<Address>& wait_for);

    std::size_t vertex_count() const { return vertex_count_; }
    std::size_t triangle_count() const { return triangle_count_; }
    std::size_t hinge_count() const { return hinge_count_; }
    std::size_t scratch_bytes() const { return limiter_->scratch_bytes(); }
    py::dict options() const;

private:
    std::mutex mutex_;
    std::size_t vertex_count_;
    std::size_t triangle_count_ = 0;
    std::size_t hinge_count_ = 0;
    host::ContextHandle context_;
    std::optional<StrainLimiter> limiter_;
};

}  // namespace apsl::python
