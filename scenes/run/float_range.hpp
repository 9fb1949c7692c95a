// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"

#include <optional>
#include <string>

namespace apsl::scenes {

/// What of the cloth the 32 bits of a device do not hold, and what to do about it; nothing where they hold all.
std::optional<std::string> beyond_float_range(const ClothState& cloth);

}  // namespace apsl::scenes
