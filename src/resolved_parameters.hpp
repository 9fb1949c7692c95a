// SPDX-License-Identifier: MIT
#pragma once

#include "stepping.hpp"

#include <apsl/options.hpp>
#include <apsl/parameters.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace apsl {

/// The parameters of a call with what follows from them, made once where they come in: nothing below asks again whether
/// steps are small or α follows a schedule.
struct ResolvedParameters : Parameters {
    /// Sub-steps that move on by a part of the time step, an equal one each; 0 where all correct at its end.
    int small_steps = 0;
    /// Whether sub-steps may raise masses. Stiffness grows with the square of a part of Δt: in fewer and longer parts
    /// ordinary vertices would be taken for light ones.
    bool raises_masses = false;
    float solve_tolerance = 0.0f;  ///< ‖r‖ / ‖b‖ at which CG stops
    float first_alpha = 1.0f;      ///< α of the first sub-step; `regularization` is that of the last

    /// Takes as many sub-steps as a whole step with this greatest excess of stretch asks for, or the calls before.
    void follow(double excess, float asked) {
        const double wanted = std::ceil(std::max(excess / APSLK_EXCESS_A_SUB_STEP, static_cast<double>(asked)));
        const int more =
            (wanted < most_sub_steps ? std::max(static_cast<int>(wanted), sub_steps) : most_sub_steps) - sub_steps;
        sub_steps += more;
        small_steps += more;
    }

    /// `given`: valid. Not explicit: wherever parameters are at hand, these are.
    ResolvedParameters(const Parameters& given, const Options& options = {}) : Parameters(given) {
        // Below 20 sub-steps the parts are long, so that solves must be tighter than usual: automatic leaves the step
        // whole. Positions alone have no velocities to move on by.
        const bool small =
            stepping == Stepping::small_steps ||
            (stepping == Stepping::automatic && (options.limits_stretch || options.integrates ||
                                                 options.keeps_contacts || sub_steps >= least_automatic_small_steps));
        if (enabled && small && !options.positions_only && sub_steps >= 2) small_steps = sub_steps - 1;
        raises_masses = small_steps > 0 && (options.limits_stretch || sub_steps >= least_automatic_small_steps);
        solve_tolerance = small_steps > 0 ? std::min(3.0f * tolerance, 0.9f) : tolerance;
        first_alpha = first_regularization > 0.0f && sub_steps > 1 ? first_regularization : regularization;
        const bool follows = options.limits_stretch && small_steps > 0 && first_regularization == 0.0f;
        if (most_sub_steps == 0)
            most_sub_steps = follows
                                 ? static_cast<int>(std::min(2.0 * sub_steps, double{std::numeric_limits<int>::max()}))
                                 : sub_steps;
    }
};

}  // namespace apsl
