// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

namespace apsl::methods {

/// All edges at rest length, one sparse direct solve an iteration; knobs: iterations, tolerance, regularization, quads.
std::unique_ptr<Method> make_fast_projection(const Cloth& cloth, std::span<const double> values);
MethodInfo fast_projection_info();

}  // namespace apsl::methods
