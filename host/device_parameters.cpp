// SPDX-License-Identifier: MIT
#include "device_parameters.hpp"

#include "raised_masses.hpp"
#include "stepping.hpp"

#include <algorithm>
#include <cmath>

namespace apsl::host {

apsl_parameters device_parameters(const Parameters& p) {
    const bool scheduled = p.first_regularization > 0.0f && p.sub_steps > 1;
    const float damping_step = scheduled ? std::log2((p.first_regularization - 1.0f) / (p.regularization - 1.0f)) /
                                               static_cast<float>(p.sub_steps - 1)
                                         : 0.0f;
    // 32-bit residuals get no smaller than a few roundings of the right-hand side: beyond, iterations only add noise.
    const float tolerance = std::max(solve_tolerance(p), 1e-6f);
    const bool on = p.enabled;
    return {.time_step = p.time_step,
            .regularization = p.regularization,
            .damping_step = damping_step,
            .target_area_change = p.target_area_change,
            .tolerance_squared = tolerance * tolerance,
            .sub_steps = on ? p.sub_steps : 0,
            .max_iterations = p.max_iterations,
            .adaptive_iterations = p.adaptive_iterations,
            .walked = on ? walked_sub_steps(p) : 0,
            .enabled = on,
            .raises_masses = on && raises_masses(p),
            .padding = {}};
}

}  // namespace apsl::host
