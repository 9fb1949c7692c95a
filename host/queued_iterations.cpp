// SPDX-License-Identifier: MIT
#include "queued_iterations.hpp"

#include "chebyshev_products.hpp"
#include "scheduled_regularization.hpp"

#include <algorithm>
#include <cmath>

namespace apsl::host {
namespace {

// Below, a launch that finds nothing to do costs as much as some of the work.
constexpr std::size_t large_cloth = 65536;
// Even, so that residuals end in the even slot, as finish_solve expects them.
constexpr int least_queued = 8;

// Iterations that bring r̄ below tolerance · b̄ (Saad 2003, Iterative Methods for Sparse Linear Systems, Section 6.11.3,
// with the root of the condition number for the change of norm), no eigenvalue of J̄J̄ᵀ being above 3/α: the scaled
// gradients around a vertex in a flat ring of equal triangles have none above 1/α, and a triangle has three vertices.
double iteration_bound(double alpha, double tolerance) {
    const double root = std::sqrt((alpha + 2.0) / (alpha - 1.0));  // of the condition number
    return 0.5 * root * std::log(2.0 * root / tolerance);
}

// The least α of any cloth in this sub-step.
double least_regularization(const CallBudget& budget, int sub_step) {
    ResolvedParameters hardest(Parameters{.regularization = budget.regularization, .sub_steps = budget.sub_steps});
    hardest.first_alpha = budget.first_alpha;
    return scheduled_regularization(double{budget.regularization}, hardest, sub_step);
}

}  // namespace

void CallBudget::add(const ResolvedParameters& p) {
    const bool is_first = max_iterations == 0;
    one_schedule = is_first || (one_schedule && sub_steps == p.most_sub_steps && first_alpha == p.first_alpha &&
                                regularization == p.regularization);
    sub_steps = std::max(sub_steps, p.most_sub_steps);
    max_iterations = std::max(max_iterations, p.max_iterations);
    if (p.bending > 0.0f) bending_iterations = std::max(bending_iterations, p.bending_iterations);
    takes_small_steps = takes_small_steps || p.small_steps > 0;
    first_alpha = std::min(first_alpha, p.first_alpha);
    regularization = std::min(regularization, p.regularization);
    tolerance = std::min(tolerance, p.solve_tolerance);
}

int queued_iterations(std::size_t largest, const CallBudget& budget, int sub_step) {
    const bool bounded = std::min(budget.first_alpha, budget.regularization) > 1.0f && budget.tolerance > 0.0f;
    if (!bounded) return budget.max_iterations;
    const double alpha = least_regularization(budget, sub_step);
    // Solves take a third to a half of the bound. On a large cloth one work-group alone would be slow: all of it.
    const double likely = iteration_bound(alpha, budget.tolerance) * (largest > large_cloth ? 1.0 : 0.5);
    const double most = budget.max_iterations;
    const double even = 2.0 * std::ceil(0.5 * std::min(likely, most));
    return std::min(std::max(static_cast<int>(even), least_queued), budget.max_iterations);
}

int queued_products(const CallBudget& budget, int sub_step, bool limits_stretch) {
    const double least = std::min(budget.first_alpha, budget.regularization);
    const bool damped = least > 1.0;
    const double alpha = budget.one_schedule && damped ? least_regularization(budget, sub_step) : least;
    return chebyshev_products(alpha, budget.max_iterations, limits_stretch);
}

}  // namespace apsl::host
