// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

namespace apsl::methods {

/// Stretch and shear of every triangle; knobs: iterations.
std::unique_ptr<Method> make_strain_based_dynamics_strain(const Cloth& cloth, std::span<const double> values);
MethodInfo strain_based_dynamics_strain_info();

/// Area of every triangle alone; knobs: iterations.
std::unique_ptr<Method> make_strain_based_dynamics_area(const Cloth& cloth, std::span<const double> values);
MethodInfo strain_based_dynamics_area_info();

}  // namespace apsl::methods
