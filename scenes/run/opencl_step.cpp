// SPDX-License-Identifier: MIT
#include "run/opencl_step.hpp"

#include "pipeline/geometry.hpp"
#include "run/check_opencl.hpp"
#include "run/opencl_program.hpp"
#include "run/pinned_vertices.hpp"

#include <algorithm>

namespace apsl::scenes {
OpenClStep::OpenClStep(const OpenClDevice& device, const ClothState& cloth, const StrainLimiting& settings,
                       bool profile)
    : device_(device, cloth, settings, profile),
      time_step_(static_cast<double>(settings.parameters.time_step)),
      flight_(free_flight(settings.parameters)),
      origin_(origin_for(cloth.positions)),
      pinned_(pinned_vertices(cloth)),
      states_(6 * pinned_.size()),
      positions_(cloth.positions.size()),
      velocities_(cloth.velocities.size()) {
    if (pinned_.empty()) return;
    place_pins_ = make_kernel(device_.context(), device.id, "place_pins");
    pinned_vertices_ = device_.make_buffer(std::as_bytes(std::span(pinned_)), "pinned vertices");
    pin_states_ = device_.make_buffer(std::as_bytes(std::span(states_)), "places of pins");
}

void OpenClStep::place_pins(const ClothState& cloth) {
    const bool moved_before = pins_moved_;
    pins_moved_ = false;
    for (std::size_t n = 0; n < pinned_.size(); ++n) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t component = 3 * pinned_[n] + k;
            states_[6 * n + k] = static_cast<float>(cloth.positions[component] - origin_[k]);
            states_[6 * n + 3 + k] = static_cast<float>(cloth.velocities[component]);
            pins_moved_ = pins_moved_ || cloth.velocities[component] != 0.0;
        }
    }
    if (!pins_moved_ && !moved_before) return;
    check_opencl(clEnqueueWriteBuffer(device_.queue(), pin_states_.get(), CL_TRUE, 0, states_.size() * sizeof(float),
                                      states_.data(), 0, nullptr, nullptr),
                 "uploading the places of pins");
    const auto count = static_cast<cl_uint>(pinned_.size());
    const cl_mem buffers[] = {pinned_vertices_.get(), pin_states_.get(), device_.positions(), device_.velocities()};
    check_opencl(clSetKernelArg(place_pins_.get(), 0, sizeof count, &count), "clSetKernelArg");
    for (cl_uint n = 0; n < 4; ++n)
        check_opencl(clSetKernelArg(place_pins_.get(), n + 1, sizeof(cl_mem), &buffers[n]), "clSetKernelArg");
    device_.launch(place_pins_.get(), "place_pins", pinned_.size());
}

void OpenClStep::find_contacts(std::span<const ColliderStep> colliders) {
    if (colliders.empty()) return;
    if (!contacts_) contacts_.emplace(device_, positions_.size() / 3, colliders.size());
    contacts_->fill(device_, colliders, flight_, time_step_, origin_);
}

Stats OpenClStep::step(ClothState& cloth) {
    device_.queue_call(contacts_ ? contacts_->records() : nullptr);
    for (const std::uint32_t v : pinned_)
        vector_at(std::span(cloth.positions), v) += time_step_ * vector_at(std::span(cloth.velocities), v);
    return device_.wait_for_stats();
}

void OpenClStep::read_back(ClothState& cloth) {
    const std::size_t bytes = positions_.size() * sizeof(float);
    check_opencl(clEnqueueReadBuffer(device_.queue(), device_.positions(), CL_FALSE, 0, bytes, positions_.data(), 0,
                                     nullptr, nullptr),
                 "reading positions");
    check_opencl(clEnqueueReadBuffer(device_.queue(), device_.velocities(), CL_TRUE, 0, bytes, velocities_.data(), 0,
                                     nullptr, nullptr),
                 "reading velocities");
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
        if (cloth.inverse_masses[v] == 0.0) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            cloth.positions[3 * v + k] = origin_[k] + static_cast<double>(positions_[3 * v + k]);
            cloth.velocities[3 * v + k] = static_cast<double>(velocities_[3 * v + k]);
        }
    }
}

}  // namespace apsl::scenes
