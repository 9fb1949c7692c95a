// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

namespace apsl::methods {

/// Knobs: iterations.
std::unique_ptr<Method> make_pbd_area_gauss_seidel(const Cloth& cloth, std::span<const double> values);
MethodInfo pbd_area_gauss_seidel_info();

}  // namespace apsl::methods
