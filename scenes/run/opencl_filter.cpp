// SPDX-License-Identifier: MIT
#include "run/opencl_filter.hpp"

#include "run/check_opencl.hpp"

namespace apsl::scenes {

Stats OpenClFilter::filter(ClothState& cloth, std::span<const ColliderStep> colliders) {
    const std::size_t bytes = cloth.positions.size() * sizeof(float);
    const std::array<double, 3> origin = origin_for(cloth.positions);
    uploaded_positions_ = to_float_around(origin, cloth.positions);
    uploaded_velocities_ = to_float(cloth.velocities);
    check_opencl(clEnqueueWriteBuffer(device_.queue(), device_.positions(), CL_FALSE, 0, bytes,
                                      uploaded_positions_.data(), 0, nullptr, nullptr),
                 "uploading positions");
    check_opencl(clEnqueueWriteBuffer(device_.queue(), device_.velocities(), CL_FALSE, 0, bytes,
                                      uploaded_velocities_.data(), 0, nullptr, nullptr),
                 "uploading velocities");
    if (keeps_contacts_) {
        if (!contacts_) contacts_.emplace(device_, cloth.inverse_masses.size(), colliders.size());
        contacts_->fill(device_, colliders, {.seconds = time_step_}, time_step_, origin);
    }
    device_.queue_call(keeps_contacts_ ? contacts_->records() : nullptr);
    check_opencl(clEnqueueReadBuffer(device_.queue(), device_.velocities(), CL_FALSE, 0, bytes,
                                     filtered_velocities_.data(), 0, nullptr, nullptr),
                 "reading velocities");
    const Stats stats = device_.wait_for_stats();

    // Only the filter's correction goes into the 64-bit velocities, not the rounding of the rest to 32 bits.
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
        if (cloth.inverse_masses[v] == 0.0) continue;
        for (std::size_t k = 3 * v; k < 3 * v + 3; ++k)
            cloth.velocities[k] += static_cast<double>(filtered_velocities_[k]) - uploaded_velocities_[k];
    }
    return stats;
}

}  // namespace apsl::scenes
