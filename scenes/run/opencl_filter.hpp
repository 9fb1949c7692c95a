// SPDX-License-Identifier: MIT
#pragma once

#include "run/opencl_cloth.hpp"

#include <vector>

namespace apsl::scenes {

/// The filter on the device, with the rest of the pipeline on the host: velocities there and back at every call.
class OpenClFilter {
public:
    /// As OpenClCloth.
    OpenClFilter(const OpenClDevice& device, const ClothState& cloth, const StrainLimiting& settings, bool profile)
        : device_(device, cloth, settings, profile), filtered_velocities_(cloth.velocities.size()) {}

    /// Filters the cloth's velocities and waits for the result.
    Stats filter(ClothState& cloth);

    OpenClCloth& device() { return device_; }

private:
    OpenClCloth device_;
    std::vector<float> uploaded_positions_;   // [3V]
    std::vector<float> uploaded_velocities_;  // [3V]
    std::vector<float> filtered_velocities_;  // [3V]
};

}  // namespace apsl::scenes
