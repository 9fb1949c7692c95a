// SPDX-License-Identifier: MIT
#include "run/reference_filter.hpp"

namespace apsl::scenes {

ReferenceFilter::ReferenceFilter(const ClothState& cloth, const StrainLimiting& settings)
    : parameters_(settings.parameters),
      regularization_(settings.regularization.begin(), settings.regularization.end()),
      limiter_(cloth.topology, settings.options) {
}

Stats ReferenceFilter::filter(ClothState& cloth) {
    limiter_.enqueue({.positions = cloth.positions,
                      .velocities = cloth.velocities,
                      .inverse_masses = cloth.inverse_masses,
                      .rest_areas = cloth.rest_areas,
                      .regularization = regularization_},
                     parameters_);
    return limiter_.read_stats();
}

}  // namespace apsl::scenes
