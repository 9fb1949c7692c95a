// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

namespace apsl::methods {

/// Knobs: iterations; compliance, m/N.
std::unique_ptr<Method> make_xpbd_edges(const Cloth& cloth, std::span<const double> values);
MethodInfo xpbd_edges_info();

}  // namespace apsl::methods
