// SPDX-License-Identifier: MIT
#pragma once

#include "stability/fuzz/random_numbers.hpp"
#include "support/device_cloth.hpp"

#include <memory>

namespace apsl::test {

/// A cloth with the given triangles in any state: at rest, stretched, crumpled, collapsed to a point or a line,
/// flipped, displaced as contact leaves it, a kilometre away, needles up to 1e4 long, as fast as 1e30 m/s, with numbers
/// below the smallest normal one; any masses and pins; triangles without rest area. Every number is finite, and α ≥ 1.
MovingCloth random_state(Random& random, const Mesh& mesh, std::shared_ptr<const Topology> topology);

}  // namespace apsl::test
