// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/error.hpp>

#include <cstddef>
#include <string>

namespace apsl::reference {

/// Throws Error(invalid_argument) where an array has not the size that the topology asks for.
inline void check_size(const char* name, std::size_t given, std::size_t expected) {
    if (given != expected)
        throw Error(ErrorCode::invalid_argument, std::string(name) + " holds " + std::to_string(given) +
                                                     " numbers, expected " + std::to_string(expected));
}

}  // namespace apsl::reference
