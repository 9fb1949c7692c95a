// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

namespace apsl::methods {

/// Inextensible triangles between edge midpoints; knobs: iterations (on the midpoints), passes (midpoints and back).
std::unique_ptr<Method> make_nonconforming_edge_midpoint(const Cloth& cloth, std::span<const double> values);
MethodInfo nonconforming_edge_midpoint_info();

}  // namespace apsl::methods
