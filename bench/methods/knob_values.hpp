// SPDX-License-Identifier: MIT
//
// What several methods' knobs have in common.
#pragma once

#include "methods/method.hpp"

#include <vector>

namespace apsl::methods {

/// The knob `iterations`: a whole number ≥ 1, its sweep doubling from 1 to 640.
KnobInfo iterations_knob(double standard);

/// A knob that counts something, as a number. Throws Error(invalid_argument) where it is not whole or above a million.
int whole_number(const char* knob, double value);

/// Throws Error(invalid_argument) naming the knob unless least ≤ value ≤ greatest.
void require_between(const char* knob, double value, double least, double greatest);

}  // namespace apsl::methods
