// SPDX-License-Identifier: MIT
#include "run/reference_filter.hpp"

#include "run/rest_shapes.hpp"
#include "run/scene_tethers.hpp"

#include <utility>

namespace apsl::scenes {

ReferenceFilter::ReferenceFilter(const ClothState& cloth, const StrainLimiting& settings)
    : parameters_(settings.parameters),
      keeps_contacts_(settings.options.keeps_contacts),
      regularization_(settings.regularization.begin(), settings.regularization.end()),
      limiter_(cloth.topology, settings.options) {
    if (settings.options.stretch_ceiling_per_triangle)
        stretch_ceilings_.assign(settings.stretch_ceilings.begin(), settings.stretch_ceilings.end());
    if (settings.options.limits_stretch) rest_shapes_ = rest_shapes(cloth);
    if (settings.options.tethers_per_vertex > 0) {
        Tethers tethers = scene_tethers(cloth, settings);
        tether_anchors_ = std::move(tethers.anchors);
        tether_lengths_.assign(tethers.lengths.begin(), tethers.lengths.end());
    }
    if (settings.options.bends) rest_hinges_ = reference::rest_hinges<double>(*cloth.topology, cloth.rest_positions);
}

Stats ReferenceFilter::filter(ClothState& cloth, std::span<const ColliderStep> colliders) {
    const auto time_step = static_cast<double>(parameters_.time_step);
    std::vector<double> touched;
    if (keeps_contacts_) touched = contacts(cloth, colliders, {.seconds = time_step}, time_step);
    return call(cloth, {}, touched);
}

Stats ReferenceFilter::call(ClothState& cloth, std::span<double> end_positions, std::span<const double> contacts) {
    limiter_.enqueue({.positions = cloth.positions,
                      .velocities = cloth.velocities,
                      .inverse_masses = cloth.inverse_masses,
                      .rest_areas = cloth.rest_areas,
                      .regularization = regularization_,
                      .rest_shapes = rest_shapes_,
                      .stretch_ceilings = stretch_ceilings_,
                      .contacts = contacts,
                      .end_positions = end_positions,
                      .rest_hinges = rest_hinges_,
                      .tether_anchors = tether_anchors_,
                      .tether_lengths = tether_lengths_},
                     parameters_);
    return limiter_.read_stats();
}

}  // namespace apsl::scenes
