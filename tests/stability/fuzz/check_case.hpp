// SPDX-License-Identifier: MIT
#pragma once

#include "stability/fuzz/properties.hpp"

#include <memory>
#include <optional>

namespace apsl::test {

/// Runs cases on the device and on the reference in both precisions, and looks at every property. A limiter is kept for
/// the next case where that can use it.
class CaseChecker {
public:
    /// The first violation, with backend, call and cloth in its details.
    std::optional<Violation> check(const FuzzCase& c);

private:
    std::optional<Violation> check_all(const FuzzCase& c);

    std::unique_ptr<DeviceFilter> device_;
};

}  // namespace apsl::test
