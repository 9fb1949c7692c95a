// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"
#include "run/scene.hpp"

#include <apsl/reference.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace apsl::scenes {

/// apsl::reference::StrainLimiter on the cloth as it is: double precision, one thread, no device.
class ReferenceFilter {
public:
    ReferenceFilter(const ClothState& cloth, const StrainLimiting& settings);

    /// Filters the cloth's velocities.
    Stats filter(ClothState& cloth);

    std::string device_name() const { return "this processor, one thread, double precision"; }
    std::size_t device_bytes() const { return 0; }

private:
    Parameters parameters_;
    std::vector<double> regularization_;    // [T] or empty
    std::vector<double> rest_shapes_;       // [4T] or empty
    std::vector<double> stretch_ceilings_;  // [T] or empty
    reference::StrainLimiter limiter_;
};

}  // namespace apsl::scenes
