// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

namespace apsl::methods {

/// Knobs: iterations; limit, the strain s in [0, 1) that edges may have.
std::unique_ptr<Method> make_edge_limits_jacobi(const Cloth& cloth, std::span<const double> values);
MethodInfo edge_limits_jacobi_info();

}  // namespace apsl::methods
