// SPDX-License-Identifier: MIT
#pragma once

#include "support/device_cloth.hpp"

#include <catch2/catch.hpp>
#include <iostream>
#include <string>

namespace apsl::test {

/// Whether the driver is one that the library does not ask for program binaries: pocl 6 with LLVM 18. Checks that there
/// is none then, and says SKIPPED for CTest: the calling test has nothing more to look at.
inline bool without_binaries() {
    cl_platform_id platform = nullptr;
    require_success(clGetDeviceInfo(device().id, CL_DEVICE_PLATFORM, sizeof platform, &platform, nullptr),
                    "clGetDeviceInfo");
    std::string version(1024, '\0');
    require_success(clGetPlatformInfo(platform, CL_PLATFORM_VERSION, version.size(), version.data(), nullptr),
                    "clGetPlatformInfo");
    if (version.find("PoCL 6.") == std::string::npos || version.find("LLVM 18.") == std::string::npos) return false;
    const StrainLimiter limiter(device().context, device().id, moving_cloth(tetrahedron(), 1).topology);
    REQUIRE(limiter.program_binary().empty());
    std::cout << "SKIPPED: pocl 6 with LLVM 18 gives no program binary\n";
    return true;
}

}  // namespace apsl::test
