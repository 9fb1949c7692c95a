// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>

namespace apsl::test {

/// Whether tests are to go through every work-group size and all random cases: `ctest --preset thorough`, which sets
/// APSL_TEST_THOROUGH. An ordinary run takes fewer. On a CPU a test of the device is nearly all compiling, each size
/// anew.
inline bool thorough() {
    const char* value = std::getenv("APSL_TEST_THOROUGH");
    return value != nullptr && *value != '\0';
}

}  // namespace apsl::test
