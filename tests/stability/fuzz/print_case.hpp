// SPDX-License-Identifier: MIT
#pragma once

#include "stability/fuzz/fuzz_case.hpp"

#include <ostream>

namespace apsl::test {

/// The case in words and numbers, with all digits of each 32-bit number.
void print(const FuzzCase& c, std::ostream& out);

}  // namespace apsl::test
