// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/error.hpp>

#include <string>

namespace apsl {

/// Throws Error(invalid_argument).
[[noreturn]] inline void invalid(const std::string& what) {
    throw Error(ErrorCode::invalid_argument, what);
}

}  // namespace apsl
