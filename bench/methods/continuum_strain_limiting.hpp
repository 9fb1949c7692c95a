// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

namespace apsl::methods {

/// Principal stretches of every triangle held in [1 − limit, 1 + limit]; knobs: iterations, limit.
std::unique_ptr<Method> make_continuum_strain_limiting(const Cloth& cloth, std::span<const double> values);
MethodInfo continuum_strain_limiting_info();

}  // namespace apsl::methods
