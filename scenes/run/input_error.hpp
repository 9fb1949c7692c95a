// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>

namespace apsl::scenes {

/// Wrong usage, scene, mesh, device or output place: one line that names what, where and what was expected.
/// The program ends with exit code 2.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace apsl::scenes
