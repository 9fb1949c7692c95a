// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"
#include "pipeline/contacts.hpp"
#include "run/scene.hpp"

#include <apsl/reference.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace apsl::scenes {

/// apsl::reference::StrainLimiter on the cloth as it is: double precision, one thread, no device.
class ReferenceFilter {
public:
    ReferenceFilter(const ClothState& cloth, const StrainLimiting& settings);

    /// Filters the cloth's velocities. `colliders`: as OpenClFilter takes them.
    Stats filter(ClothState& cloth, std::span<const ColliderStep> colliders = {});
    /// A call, with positions at the end of the step where it is a whole one: m, [3V], or none, and with contacts,
    /// [8V], where it keeps them.
    Stats call(ClothState& cloth, std::span<double> end_positions, std::span<const double> contacts);

    static std::string device_name() { return "this processor, one thread, double precision"; }

    bool keeps_contacts() const { return keeps_contacts_; }

private:
    Parameters parameters_;
    bool keeps_contacts_;
    std::vector<double> regularization_;    // [T] or empty
    std::vector<double> rest_shapes_;       // [4T] or empty
    std::vector<double> stretch_ceilings_;  // [T] or empty
    std::vector<double> rest_hinges_;       // [2H] or empty
    std::vector<std::uint32_t> tether_anchors_;
    std::vector<double> tether_lengths_;
    reference::StrainLimiter limiter_;
};

}  // namespace apsl::scenes
