// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/parameters.hpp>

#include <algorithm>

namespace apsl {

/// From so many sub-steps up Stepping::automatic takes small steps.
inline constexpr int least_automatic_small_steps = 20;

/// The area that a small step asks of a triangle at most, as a multiple of its present area. A linearised step from
/// nearly no area overshoots without bound.
inline constexpr float greatest_growth = 4.0f;

/// Sub-steps that move on by a part of the time step, an equal one each; 0 where all correct at its end. Below 20
/// sub-steps the parts are long, so that solves must be tighter than usual: Stepping::automatic leaves the step whole.
inline int walked_sub_steps(const Parameters& parameters) {
    const bool small =
        parameters.stepping == Stepping::small_steps ||
        (parameters.stepping == Stepping::automatic && parameters.sub_steps >= least_automatic_small_steps);
    return small && parameters.sub_steps >= 2 ? parameters.sub_steps - 1 : 0;
}

/// The share of the start's area error that is still there as planned after sub-step `sub_step` of a walk of `parts`
/// parts: it is led back to zero over the whole step (docs/formulation.md, Small steps).
inline float start_error_left(int sub_step, int parts) {
    return sub_step < parts ? static_cast<float>(parts - 1 - sub_step) / static_cast<float>(parts) : 0.0f;
}

/// ‖r‖ / ‖b‖ at which CG stops.
inline float solve_tolerance(const Parameters& parameters) {
    return walked_sub_steps(parameters) > 0 ? std::min(3.0f * parameters.tolerance, 0.9f) : parameters.tolerance;
}

}  // namespace apsl
