// SPDX-License-Identifier: MIT
#pragma once

#include "unit/reference/sample_cloths.hpp"

#include <apsl/reference.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace apsl::test {

/// A grid cloth, and calls of the reference on it.
struct SteppedSheet : SampleCloth {
    std::vector<double> velocities, rest_shapes, contacts = {};

    explicit SteppedSheet(std::uint32_t side)
        : SampleCloth(grid_cloth(side, side, Diagonals::alternating)),
          velocities(positions.size(), 0.0),
          rest_shapes(reference::rest_shapes<double>(*topology, positions)) {}

    Stats call(const Parameters& parameters, const Options& options) {
        reference::StrainLimiter limiter(topology, options);
        limiter.enqueue(
            {.positions = positions,
             .velocities = velocities,
             .inverse_masses = inverse_masses,
             .rest_areas = rest_areas,
             .regularization = {},
             .rest_shapes = options.limits_stretch ? std::span<const double>(rest_shapes) : std::span<const double>(),
             .contacts = contacts,
             .end_positions = options.integrates ? std::span<double>(positions) : std::span<double>()},
            parameters);
        return limiter.read_stats();
    }
};

}  // namespace apsl::test
