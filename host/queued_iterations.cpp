// SPDX-License-Identifier: MIT
#include "queued_iterations.hpp"

#include "chebyshev_products.hpp"
#include "scheduled_regularization.hpp"
#include "stepping.hpp"

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
    const Parameters hardest{.regularization = budget.regularization,
                             .sub_steps = budget.sub_steps,
                             .first_regularization = budget.first_regularization};
    return scheduled_regularization(double{budget.regularization}, hardest, sub_step);
}

}  // namespace

void CallBudget::add(const Parameters& p) {
    const bool scheduled = p.first_regularization > 0.0f && p.sub_steps > 1;
    const float first = scheduled ? p.first_regularization : p.regularization;
    const bool is_first = max_iterations == 0;
    one_schedule = is_first || (one_schedule && sub_steps == p.sub_steps && first_regularization == first &&
                                regularization == p.regularization);
    sub_steps = std::max(sub_steps, p.sub_steps);
    max_iterations = std::max(max_iterations, p.max_iterations);
    walks = walks || walked_sub_steps(p) > 0;
    first_regularization = std::min(first_regularization, first);
    regularization = std::min(regularization, p.regularization);
    tolerance = std::min(tolerance, solve_tolerance(p));
}

int queued_iterations(std::size_t largest, const CallBudget& budget, int sub_step) {
    const bool bounded = std::min(budget.first_regularization, budget.regularization) > 1.0f && budget.tolerance > 0.0f;
    if (!bounded) return budget.max_iterations;
    const double alpha = least_regularization(budget, sub_step);
    // Solves take a third to a half of the bound. On a large cloth one work-group alone would be slow: all of it.
    const double likely = iteration_bound(alpha, budget.tolerance) * (largest > large_cloth ? 1.0 : 0.5);
    const double most = budget.max_iterations;
    const double even = 2.0 * std::ceil(0.5 * std::min(likely, most));
    return std::min(std::max(static_cast<int>(even), least_queued), budget.max_iterations);
}

int queued_products(const CallBudget& budget, int sub_step) {
    const double least = std::min(budget.first_regularization, budget.regularization);
    const bool damped = least > 1.0;
    const double alpha = budget.one_schedule && damped ? least_regularization(budget, sub_step) : least;
    return chebyshev_products(alpha, budget.max_iterations);
}

}  // namespace apsl::host
