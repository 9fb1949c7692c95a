// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/parameters.hpp>

#include <algorithm>

namespace apsl {

/// Sub-steps that move on by a part of the time step, an equal one each; 0 where all correct at its end. Below 20
/// sub-steps the parts are long, so that solves must be tighter than usual: Stepping::automatic leaves the step whole.
inline int walked_sub_steps(const Parameters& parameters) {
    constexpr int least = 20;
    const bool small = parameters.stepping == Stepping::small_steps ||
                       (parameters.stepping == Stepping::automatic && parameters.sub_steps >= least);
    return small && parameters.sub_steps >= 2 ? parameters.sub_steps - 1 : 0;
}

/// ‖r‖ / ‖b‖ at which CG stops.
inline float solve_tolerance(const Parameters& parameters) {
    return walked_sub_steps(parameters) > 0 ? std::min(3.0f * parameters.tolerance, 0.9f) : parameters.tolerance;
}

}  // namespace apsl
