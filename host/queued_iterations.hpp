// SPDX-License-Identifier: MIT
#pragma once

#include "resolved_parameters.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>

namespace apsl::host {

/// Launches for solves and bending that a call queues at most. On a processor by pocl each takes 0.4 kB until it is
/// done, and some 25 µs. 10000 sub-steps at the default settings stay below.
inline constexpr std::int64_t most_launches = 1'000'000;

/// What a call may take at most, over the parameters of all its cloths that are on.
struct CallBudget {
    int sub_steps = 0;
    int max_iterations = 0;
    int bending_iterations = 0;      ///< of cloths that resist bending
    bool takes_small_steps = false;  ///< a cloth takes small steps
    bool one_schedule = true;        ///< α is the same for all cloths, sub-step by sub-step
    // The least of any: what makes for the longest solves.
    float first_alpha = std::numeric_limits<float>::infinity();
    float regularization = std::numeric_limits<float>::infinity();
    float tolerance = std::numeric_limits<float>::infinity();  ///< of the solves

    void add(const ResolvedParameters& parameters);
};

/// CG iterations of a solve in sub-step `sub_step` that are queued as launches over the whole device, where the largest
/// cloth has `largest` triangles. What is left of max_iterations is one launch of finish_solve, by one work-group a
/// cloth: seldom more than a formality.
int queued_iterations(std::size_t largest, const CallBudget& budget, int sub_step);

/// Products of a Chebyshev solve in sub-step `sub_step`: as many as the cloth with most of them takes.
int queued_products(const CallBudget& budget, int sub_step, bool limits_stretch);

}  // namespace apsl::host
