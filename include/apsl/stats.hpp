// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace apsl {

/// How a filter call ended.
enum class Status : std::int32_t {
    ok = 0,
    not_converged = 1,  ///< at least one solve used all its iterations; the best state reached stands
    diverged = 2,       ///< not finite, going in or on the way: positions and velocities are as they were given
};

/// What one filter call did to one cloth. The device writes this layout itself (kernels/layout.h).
struct Stats {
    std::int32_t sub_steps;      ///< solves done
    std::int32_t cg_iterations;  ///< over all of them
    float residual;              ///< greatest ‖r‖ / ‖b‖ at the end of a solve, norm as in Parameters::tolerance
    float max_area_change;       ///< max |A − A⁰| / A⁰ after the last sub-step
    float rms_area_change;       ///< root of the mean of its squares, over triangles with A⁰ > 0
    Status status;               ///< how the call ended for this cloth
};
static_assert(sizeof(Stats) == 24);

}  // namespace apsl
