// SPDX-License-Identifier: MIT
#pragma once

#include "stability/fuzz/fuzz_case.hpp"

#include <functional>

namespace apsl::test {

/// A smaller case that still fails: fewer calls, cloths, triangles and vertices, default parameters and options,
/// simpler numbers. Greedy: every change that still fails stays, until none does or `trials` cases were run.
FuzzCase shrink(FuzzCase c, const std::function<bool(const FuzzCase&)>& still_fails, int trials);

}  // namespace apsl::test
