// SPDX-License-Identifier: MIT
#pragma once

#include "run/opencl_cloth.hpp"
#include "run/opencl_contacts.hpp"

#include <optional>
#include <span>
#include <vector>

namespace apsl::scenes {

/// The filter on the device, with the rest of the pipeline on the host: velocities there and back at every call.
class OpenClFilter {
public:
    /// As OpenClCloth.
    OpenClFilter(const OpenClDevice& device, const ClothState& cloth, const StrainLimiting& settings, bool profile)
        : device_(device, cloth, settings, profile),
          time_step_(static_cast<double>(settings.parameters.time_step)),
          keeps_contacts_(settings.options.keeps_contacts),
          filtered_velocities_(cloth.velocities.size()) {}

    /// Filters the cloth's velocities and waits for the result. `colliders`: with Options::keeps_contacts, and then not
    /// none.
    Stats filter(ClothState& cloth, std::span<const ColliderStep> colliders = {});

    bool keeps_contacts() const { return keeps_contacts_; }

    OpenClCloth& device() { return device_; }

private:
    OpenClCloth device_;
    double time_step_;  // s
    bool keeps_contacts_;
    std::optional<OpenClContacts> contacts_;
    std::vector<float> uploaded_positions_;   // [3V]
    std::vector<float> uploaded_velocities_;  // [3V]
    std::vector<float> filtered_velocities_;  // [3V]
};

}  // namespace apsl::scenes
