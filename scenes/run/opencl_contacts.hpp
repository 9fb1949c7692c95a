// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/contacts.hpp"
#include "run/opencl_cloth.hpp"

#include <array>
#include <span>

namespace apsl::scenes {

/// What the vertices of a cloth on the device are held off, written there by fill_contacts.cl.
class OpenClContacts {
public:
    /// `colliders`: their number, ≥ 1. Throws InputError (an OpenCL call failed).
    OpenClContacts(OpenClCloth& cloth, std::size_t vertices, std::size_t colliders);

    /// Queues contacts() of positions and velocities of the same cloth as they are there, around `origin` (m) like the
    /// positions. As many colliders as said.
    void fill(OpenClCloth& cloth, std::span<const ColliderStep> colliders, const FreeFlight& flight, double time_step,
              const std::array<double, 3>& origin);

    cl_mem records() const { return records_.get(); }  ///< [8V]

private:
    std::size_t vertices_;
    host::KernelHandle kernel_;
    host::BufferHandle colliders_;
    host::BufferHandle records_;
};

}  // namespace apsl::scenes
