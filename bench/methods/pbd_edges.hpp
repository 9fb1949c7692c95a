// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

namespace apsl::methods {

/// Knobs: iterations; stiffness, k in [0, 1].
std::unique_ptr<Method> make_pbd_edges(const Cloth& cloth, std::span<const double> values);
MethodInfo pbd_edges_info();

}  // namespace apsl::methods
