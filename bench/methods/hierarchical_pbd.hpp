// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

namespace apsl::methods {

/// Edges at rest length, level by level; knobs: iterations (on each level), levels.
std::unique_ptr<Method> make_hierarchical_pbd(const Cloth& cloth, std::span<const double> values);
MethodInfo hierarchical_pbd_info();

}  // namespace apsl::methods
