// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

namespace apsl::methods {

/// Knobs: iterations.
std::unique_ptr<Method> make_ring_area(const Cloth& cloth, std::span<const double> values);
MethodInfo ring_area_info();

}  // namespace apsl::methods
