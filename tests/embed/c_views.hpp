// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/apsl.h>
#include <apsl/strain_limiter.hpp>

namespace apsl::test {

/// The same buffers for the C interface.
inline apsl_buffers c_views(const Buffers& v) {
    return {{v.positions.buffer, v.positions.offset},
            {v.velocities.buffer, v.velocities.offset},
            {v.inverse_masses.buffer, v.inverse_masses.offset},
            {v.rest_areas.buffer, v.rest_areas.offset},
            {v.regularization.buffer, v.regularization.offset},
            {v.rest_shapes.buffer, v.rest_shapes.offset},
            {v.stretch_ceilings.buffer, v.stretch_ceilings.offset},
            {v.contacts.buffer, v.contacts.offset},
            {v.rest_hinges.buffer, v.rest_hinges.offset},
            {v.accelerations.buffer, v.accelerations.offset},
            {v.tether_anchors.buffer, v.tether_anchors.offset},
            {v.tether_lengths.buffer, v.tether_lengths.offset}};
}

}  // namespace apsl::test
