// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/error.hpp>

#include <functional>
#include <string>

namespace apsl::test {

/// The action must throw Error with this code and one line that says `what`, and queue nothing.
void check_error(ErrorCode code, const std::string& what, const std::function<void()>& action);

/// The same with ErrorCode::invalid_argument.
void check_invalid(const std::string& what, const std::function<void()>& action);

}  // namespace apsl::test
