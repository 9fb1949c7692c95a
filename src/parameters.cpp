// SPDX-License-Identifier: MIT
#include "finite.hpp"

#include <apsl/error.hpp>
#include <apsl/parameters.hpp>

#include <sstream>

namespace apsl {
namespace {

template <class Value>
void require(bool legal, const char* field, Value value, const char* expected) {
    if (legal) return;
    std::ostringstream message;
    message << field << " is " << value << ", expected " << expected;
    throw Error(ErrorCode::invalid_argument, message.str());
}

}  // namespace

void validate(const Parameters& p) {
    require(is_finite(p.time_step) && p.time_step > 0.0f, "time_step", p.time_step, "a finite number > 0 (seconds)");
    require(is_finite(p.regularization) && p.regularization >= 1.0f, "regularization", p.regularization,
            "a finite number >= 1 (alpha multiplies the diagonal of G)");
    require(p.sub_steps >= 0, "sub_steps", p.sub_steps, "a whole number >= 0");
    require(is_finite(p.target_area_change) && p.target_area_change >= 0.0f, "target_area_change", p.target_area_change,
            "a finite number >= 0 (a fraction of the rest area)");
    require(is_finite(p.tolerance) && p.tolerance >= 0.0f && p.tolerance < 1.0f, "tolerance", p.tolerance,
            "a number in [0, 1)");
    require(p.max_iterations >= 1, "max_iterations", p.max_iterations, "a whole number >= 1");
    require(p.adaptive_iterations >= 0, "adaptive_iterations", p.adaptive_iterations,
            "a whole number >= 0 (0 keeps the regularization as given)");
    const float first = p.first_regularization;
    require(is_finite(first) && (first == 0.0f || first > 1.0f), "first_regularization", first,
            "0 (the same in every sub-step) or a finite number > 1");
    require(first == 0.0f || p.regularization > 1.0f, "regularization", p.regularization,
            "a number > 1 where first_regularization is given");
    require(
        p.stepping == Stepping::automatic || p.stepping == Stepping::whole_step || p.stepping == Stepping::small_steps,
        "stepping", static_cast<std::int32_t>(p.stepping), "automatic (0), whole_step (1) or small_steps (2)");
}

}  // namespace apsl
