// SPDX-License-Identifier: MIT
#include "embed/refusals.hpp"

#include "embed/opencl_calls.hpp"

#include <catch2/catch.hpp>

namespace apsl::test {

void check_error(ErrorCode code, const std::string& what, const std::function<void()>& action) {
    CAPTURE(what);
    const int commands = opencl_calls().commands;
    bool thrown = false;
    try {
        action();
    } catch (const Error& error) {
        thrown = true;
        const std::string message = error.what();
        CHECK(error.code() == code);
        CHECK_THAT(message, Catch::Contains(what));
        CHECK(message.find('\n') == std::string::npos);
    }
    CHECK(thrown);
    CHECK(opencl_calls().commands == commands);
}

void check_invalid(const std::string& what, const std::function<void()>& action) {
    check_error(ErrorCode::invalid_argument, what, action);
}

}  // namespace apsl::test
