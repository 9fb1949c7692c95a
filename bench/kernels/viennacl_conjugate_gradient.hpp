// SPDX-License-Identifier: MIT
#pragma once

#include "device.hpp"
#include "pressure_system.hpp"

namespace apsl::bench {

/// ViennaCL's pipelined Conjugate Gradient, float, on the same device, context and queue. It has that form without a
/// preconditioner alone, so it is given the Jacobi-scaled system S A S y = S b, λ = S y, S = 1/√diag A: the same
/// iterates as with one. `system` must outlive the result.
Solve viennacl_conjugate_gradient(const Device& device, const PressureSystem& system);

}  // namespace apsl::bench
