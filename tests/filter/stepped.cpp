// SPDX-License-Identifier: MIT
#include "filter/stepped.hpp"

#include <apsl/reference.hpp>

namespace apsl::test {

Ended step_on_device(StrainLimiter& limiter, const MovingCloth& cloth, const Options& options,
                     const Parameters& parameters) {
    const CallerBuffers buffers({&cloth, 1}, options);
    const Stats stats = filter(limiter, buffers, {&parameters, 1})[0];
    const std::vector<float> velocities = buffers.read_velocities(), positions = buffers.read_positions();
    return {{positions.begin(), positions.end()}, {velocities.begin(), velocities.end()}, stats};
}

Ended step_on_device(const MovingCloth& cloth, const Options& options, const Parameters& parameters) {
    StrainLimiter limiter(device().context, device().id, cloth.topology, options);
    return step_on_device(limiter, cloth, options, parameters);
}

Ended step_with_reference(const MovingCloth& cloth, const Options& options, const Parameters& parameters) {
    reference::StrainLimiter limiter(cloth.topology, options);
    Ended end{cloth.positions, cloth.velocities, {}};
    std::span<const double> shapes, contacts, hinges;
    if (options.limits_stretch) shapes = cloth.rest_shapes;
    if (options.keeps_contacts) contacts = cloth.contacts;
    if (options.bends) hinges = cloth.rest_hinges;
    limiter.enqueue({.positions = cloth.positions,
                     .velocities = end.velocities,
                     .inverse_masses = cloth.inverse_masses,
                     .rest_areas = cloth.rest_areas,
                     .regularization = {},
                     .rest_shapes = shapes,
                     .contacts = contacts,
                     .end_positions = end.positions,
                     .rest_hinges = hinges},
                    parameters);
    end.stats = limiter.read_stats();
    return end;
}

}  // namespace apsl::test
