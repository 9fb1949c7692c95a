// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

namespace apsl::methods {

/// Knobs: iterations; compliance, m³/N.
std::unique_ptr<Method> make_xpbd_area(const Cloth& cloth, std::span<const double> values);
MethodInfo xpbd_area_info();

}  // namespace apsl::methods
