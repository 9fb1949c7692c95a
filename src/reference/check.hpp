// SPDX-License-Identifier: MIT
#pragma once

#include "finite.hpp"

#include <apsl/error.hpp>

#include <cstddef>
#include <span>
#include <sstream>
#include <string>

namespace apsl::reference {

/// Throws Error(invalid_argument) where an array has not the size that the topology asks for.
inline void check_size(const char* name, std::size_t given, std::size_t expected) {
    if (given != expected)
        throw Error(ErrorCode::invalid_argument, std::string(name) + " holds " + std::to_string(given) +
                                                     " numbers, expected " + std::to_string(expected));
}

/// Throws Error(invalid_argument) naming the first number that is not finite or not legal; `place` is what the array
/// has one number for: "vertex" or "triangle".
template <class Real, class Legal>
void check_values(const char* name, const char* place, std::span<const Real> values, const char* expected,
                  Legal legal) {
    for (std::size_t n = 0; n < values.size(); ++n)
        if (!is_finite(values[n]) || !legal(values[n])) {
            std::ostringstream message;
            message << name << " of " << place << " " << n << " is " << values[n] << ", expected " << expected;
            throw Error(ErrorCode::invalid_argument, message.str());
        }
}

}  // namespace apsl::reference
