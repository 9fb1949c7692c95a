// SPDX-License-Identifier: MIT
#pragma once

#include "stability/fuzz/properties.hpp"
#include "stability/fuzz/random_numbers.hpp"

#include <optional>

namespace apsl::test {

/// Gives a limiter something illegal: a parameter, an option, a buffer or a mesh. It must be refused with one
/// apsl::Error of one line, and leave the limiter as it was.
std::optional<Violation> check_illegal_call(Random& random);

}  // namespace apsl::test
