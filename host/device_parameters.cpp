// SPDX-License-Identifier: MIT
#include "device_parameters.hpp"

#include <algorithm>
#include <cmath>

namespace apsl::host {

apslk_parameters device_parameters(const ResolvedParameters& p) {
    const bool scheduled = p.first_alpha != p.regularization;
    const float damping_step =
        scheduled ? std::log2((p.first_alpha - 1.0f) / (p.regularization - 1.0f)) / static_cast<float>(p.sub_steps - 1)
                  : 0.0f;
    // 32-bit residuals get no smaller than a few roundings of the right-hand side: beyond, iterations only add noise.
    const float tolerance = std::max(p.solve_tolerance, 1e-6f);
    const bool on = p.enabled;
    return {.time_step = p.time_step,
            .regularization = p.regularization,
            .damping_step = damping_step,
            .target_area_change = p.target_area_change,
            .tolerance_squared = tolerance * tolerance,
            .sub_steps = on ? p.sub_steps : 0,
            .max_iterations = p.max_iterations,
            .adaptive_threshold = p.adaptive_threshold,
            .small_steps = p.small_steps,
            .enabled = on,
            .raises_masses = p.raises_masses,
            .stretch_ceiling = p.stretch_ceiling,
            .most_sub_steps = on ? p.most_sub_steps : 0,
            .acceleration = {p.acceleration[0], p.acceleration[1], p.acceleration[2]},
            .damping = p.damping,
            .bending = p.bending,
            .bending_iterations = p.bending_iterations,
            .given_small_steps = p.small_steps,
            .padding = {}};
}

}  // namespace apsl::host
