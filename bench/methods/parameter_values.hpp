// SPDX-License-Identifier: MIT
//
// What several methods' parameters have in common.
#pragma once

#include "methods/method.hpp"

#include <vector>

namespace apsl::methods {

/// The parameter `iterations`: a whole number ≥ 1, its sweep doubling from 1 to 640.
ParameterInfo iterations_parameter(double standard);

/// A parameter that counts something, as a number. Throws Error(invalid_argument) where it is not whole or above a
/// million.
int whole_number(const char* parameter, double value);

/// Throws Error(invalid_argument) naming the parameter unless least ≤ value ≤ greatest.
void require_between(const char* parameter, double value, double least, double greatest);

}  // namespace apsl::methods
