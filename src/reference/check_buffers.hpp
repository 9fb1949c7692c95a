// SPDX-License-Identifier: MIT
#pragma once

#include "reference/check.hpp"

#include <apsl/options.hpp>
#include <apsl/reference.hpp>
#include <apsl/topology.hpp>

#include "../../kernels/constants.h"

#include <cstddef>

namespace apsl::reference {

/// Throws Error(invalid_argument) for what a call of the reference cannot take: sizes that do not fit the topology and
/// the options, numbers that are not legal. Positions and velocities that are not finite are a status.
template <class Real>
void check_buffers(const Topology& topology, const Buffers<Real>& buffers, const Options& options) {
    check_size("positions", buffers.positions.size(), 3 * topology.vertex_count());
    check_size("velocities", buffers.velocities.size(), 3 * topology.vertex_count());
    check_size("inverse_masses", buffers.inverse_masses.size(), topology.vertex_count());
    check_size("rest_areas", buffers.rest_areas.size(), topology.triangle_count());
    if (!buffers.regularization.empty())
        check_size("regularization", buffers.regularization.size(), topology.triangle_count());
    check_size("end_positions", buffers.end_positions.size(), options.integrates ? 3 * topology.vertex_count() : 0);
    check_values("inverse_masses", "vertex", buffers.inverse_masses, "a finite number >= 0 (1/kg)",
                 [](Real w) { return w >= Real(0); });
    check_values("rest_areas", "triangle", buffers.rest_areas, "a finite number >= 0 (m2; 0 is not limited)",
                 [](Real area) { return area >= Real(0); });
    check_values("regularization", "triangle", buffers.regularization, "a finite number >= 1",
                 [](Real alpha) { return alpha >= Real(1); });
    check_size("rest_shapes", buffers.rest_shapes.size(), options.limits_stretch ? 4 * topology.triangle_count() : 0);
    check_size("stretch_ceilings", buffers.stretch_ceilings.size(),
               options.stretch_ceiling_per_triangle ? topology.triangle_count() : 0);
    check_size("rest_hinges", buffers.rest_hinges.size(), options.bends ? 2 * topology.hinge_count() : 0);
    check_values("rest_hinges", "number", buffers.rest_hinges, "a finite number (rad, and m2/m2)",
                 [](Real) { return true; });
    check_values("rest_shapes", "number", buffers.rest_shapes, "a finite number (1/m)", [](Real) { return true; });
    check_values("stretch_ceilings", "triangle", buffers.stretch_ceilings, "0 or a finite number >= 1.01",
                 [](Real ceiling) { return ceiling == Real(0) || ceiling >= Real(APSLK_LEAST_STRETCH_CEILING); });
    check_size("contacts", buffers.contacts.size(),
               options.keeps_contacts ? APSLK_CONTACT_SIZE * topology.vertex_count() : 0);
    check_values("contacts", "number", buffers.contacts, "a finite number", [](Real) { return true; });
    check_size("accelerations", buffers.accelerations.size(),
               options.acceleration_per_vertex ? 3 * topology.vertex_count() : 0);
    const std::size_t tethers = std::size_t{options.tethers_per_vertex} * topology.vertex_count();
    check_size("tether_anchors", buffers.tether_anchors.size(), tethers);
    check_size("tether_lengths", buffers.tether_lengths.size(), tethers);
    check_values("tether_lengths", "tether", buffers.tether_lengths, "a finite number >= 0 (m)",
                 [](Real length) { return length >= Real(0); });
    check_values("accelerations", "number", buffers.accelerations, "a finite number (m/s2)", [](Real) { return true; });
}

}  // namespace apsl::reference
