// SPDX-License-Identifier: MIT
#include <apsl/error.hpp>

#include <utility>

namespace apsl {

Error::Error(ErrorCode code, const std::string& what_was_wrong, std::int32_t opencl_code, std::string build_log)
    : std::runtime_error(what_was_wrong), code_(code), opencl_code_(opencl_code), build_log_(std::move(build_log)) {
}

// Out of line: the one place the vtable lives, so that the type is the same on both sides of a library boundary.
Error::~Error() = default;

}  // namespace apsl
