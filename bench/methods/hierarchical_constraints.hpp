// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

namespace apsl::methods {

/// Lagrange multipliers of all edge lengths of a level at once, level by level; knobs: iterations (of the linear
/// solver, on each level), levels, passes.
std::unique_ptr<Method> make_hierarchical_constraints(const Cloth& cloth, std::span<const double> values);
MethodInfo hierarchical_constraints_info();

}  // namespace apsl::methods
