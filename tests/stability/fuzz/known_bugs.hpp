// SPDX-License-Identifier: MIT
#pragma once

#include "stability/fuzz/properties.hpp"

#include <string_view>

namespace apsl::test {

/// Bugs of the library that the fuzzer found and that are not mended yet; known_bugs.cpp has the smallest case of each,
/// and fails as soon as one is mended: then its line here goes too. Counted and said, not failed for.
constexpr std::string_view known_bugs[] = {
    "no sub-step, but velocities changed",
    "statistics that are not finite without having diverged",
    "ordinary input diverged at tolerance 0",
};

inline bool is_known(const Violation& violation) {
    for (const std::string_view bug : known_bugs)
        if (violation.property == bug) return true;
    return false;
}

}  // namespace apsl::test
