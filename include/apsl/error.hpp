// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/cxx20.hpp>
#include <apsl/export.hpp>

#include <cstdint>
#include <stdexcept>
#include <string>

namespace apsl {

/// What kind of mistake an Error reports.
enum class ErrorCode : std::int32_t {
    invalid_argument = 1,  ///< a parameter, option or size out of its range
    invalid_mesh = 2,      ///< triangles that no topology can be built from
    opencl = 3,            ///< an OpenCL call failed; opencl_code() says how
    kernel_build = 4,      ///< a kernel did not compile; build_log() says where
    unsupported = 5,       ///< the device cannot do what was asked
};

/// Every error the library throws: one line that names what, where, and what was expected.
class APSL_API Error : public std::runtime_error {
public:
    /// opencl_code: the failed call's status. build_log: what the compiler said, for kernel_build.
    Error(ErrorCode code, const std::string& what_was_wrong, std::int32_t opencl_code = 0, std::string build_log = {});
    ~Error() override;
    Error(const Error&) = default;             ///< copies all of it
    Error& operator=(const Error&) = default;  ///< likewise

    /// The kind of mistake.
    ErrorCode code() const noexcept { return code_; }
    /// The OpenCL status of the failed call, 0 where none was involved.
    std::int32_t opencl_code() const noexcept { return opencl_code_; }
    /// The compiler's output, empty unless code() is kernel_build.
    const std::string& build_log() const noexcept { return build_log_; }

private:
    ErrorCode code_;
    std::int32_t opencl_code_;
    std::string build_log_;
};

}  // namespace apsl
